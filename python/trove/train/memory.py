"""Memory that training frees and takes again at every step."""

import ctypes

# Parameters of mallopt, as glibc's malloc.h numbers them.
_TRIM_THRESHOLD, _MMAP_MAX = -1, -4


def keep_freed() -> None:
    """Has glibc keep what this process frees, for what it takes next; other C libraries are left as they are.

    Tensors of megabytes would go back to the system after every use, and come from it anew page by page: up to a quarter
    of a step of `ssdlite` on a processor.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(_MMAP_MAX, 0)
        mallopt(_TRIM_THRESHOLD, -1)
