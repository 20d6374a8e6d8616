"""`python -m launch_py PACKAGE FILE name:=value ...` launches a launch file."""

import sys
from collections.abc import Sequence

from launch_py.command.command_line import run
from launch_py.standard_streams import open_closed_streams


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    open_closed_streams()
    return run(sys.argv[1:] if argv is None else argv, program="launch_py")


if __name__ == "__main__":
    sys.exit(main())
