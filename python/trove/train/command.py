"""What the commands of this package share."""

import sys


def lacks_torch() -> bool:
    """Whether PyTorch is missing, which is said."""
    try:
        import torch  # noqa: F401
    except ModuleNotFoundError:
        print("error: PyTorch is missing; pip install 'trove-scenes[train]'", file=sys.stderr)
        return True
    return False
