"""The program xacro for launch files, whose $(find) searches like the rest of the suite.

launch_py runs it for Command(["xacro ", file]) in a launch file.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

from arm_description.errors import XacroError
from arm_description.resources import ResourceFinder
from arm_description.xacro.expansion import expand_xacro_file, findable

EXIT_FAILED = 2
"""Same as xacro's."""


def main(argv: Sequence[str] | None = None) -> int:
    """Expand a file to stdout; leave other options to xacro itself."""
    import xacro
    from xacro.cli import process_args

    options, name = process_args(list(sys.argv[1:] if argv is None else argv))
    # Without a file, `process_args` would have ended the process.
    file = Path(str(name))
    if options.output is not None or options.just_deps:
        with findable(ResourceFinder(file)):
            xacro.main()
        return 0
    try:
        text = expand_xacro_file(file, options.mappings).text
    except XacroError as error:
        sys.stderr.write(f"{error}\n")
        return EXIT_FAILED
    sys.stdout.write(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
