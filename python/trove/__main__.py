"""The command line, as the console script `trove` and as `python -m trove`."""

import signal
import sys

from trove._trove import main as run
from trove.packages import search


def main() -> None:
    """Runs the command line with this process's arguments and exits with its status."""
    # Python would only take note of Ctrl-C until the command has ended by itself.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(run(["trove", *sys.argv[1:]], search()))


if __name__ == "__main__":
    main()
