"""The program `isolux`, as the wheel installs it: the command line of the engine."""

from __future__ import annotations

import signal
import sys

from . import _native


def main() -> None:
    """Runs the command line and ends with its exit code."""
    # The command line answers Ctrl-C by itself.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_native.run(["isolux", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
