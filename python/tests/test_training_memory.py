"""What training does with memory between steps."""

import platform
import subprocess
import sys

import pytest

# Page faults while 64 MiB are taken, filled and freed ten times, once that has been done before.
_FAULTS = """
import resource, sys
from trove.train.memory import keep_freed

if sys.argv[1] == "kept":
    keep_freed()
b"x" * (64 << 20)
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
for _ in range(10):
    b"x" * (64 << 20)
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


def _faults(how: str) -> int:
    return int(subprocess.run([sys.executable, "-c", _FAULTS, how], check=True, capture_output=True, text=True).stdout)


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="other C libraries are left as they are")
def test_what_is_freed_is_taken_again_without_asking_the_system() -> None:
    assert _faults("kept") < 1000 < _faults("as it is")
