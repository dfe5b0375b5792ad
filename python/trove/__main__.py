"""The command line, as the console script `trove` and as `python -m trove`."""

import signal
import site
import sys
import sysconfig

from trove._trove import main as run


def main() -> None:
    """Runs the command line with this process's arguments and exits with its status."""
    # Python would only take note of Ctrl-C until the command has ended by itself.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    packages = [sysconfig.get_path("platlib"), *site.getsitepackages()]
    if site.ENABLE_USER_SITE:
        packages.append(site.getusersitepackages())
    sys.exit(run(["trove", *sys.argv[1:]], list(dict.fromkeys(packages))))


if __name__ == "__main__":
    main()
