"""The command `hairpin`."""

from __future__ import annotations

import signal
import sys

from hairpin import _native


def main() -> None:
    """Runs the command line of this process, and ends it with its exit code."""
    # The command listens to Ctrl-C itself, and keeps what is done.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_native.run(["hairpin", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
