"""`arm check`: reads a URDF or xacro file as the simulation would, and tells what became of it."""

import argparse
import json
import logging
from collections import Counter
from dataclasses import asdict
from typing import TYPE_CHECKING

from arm_cli.errors import ArmCliError

if TYPE_CHECKING:
    from arm_gazebo.check.description import DescriptionCheck

EXIT_UNUSABLE = 1


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the file and the options."""
    parser.add_argument("file", metavar="FILE", help="URDF or xacro file, or a package:// URI")
    parser.add_argument(
        "arguments", metavar="NAME:=VALUE", nargs="*", help="arguments of a xacro file"
    )
    parser.add_argument(
        "--package-path",
        metavar="DIR:DIR",
        default="",
        help="folders for package:// and $(find ...) besides the file's own package, its "
        "neighbours and the installed ones",
    )
    parser.add_argument(
        "--strict", action="store_true", help="a mesh that cannot be had is an error"
    )
    shown = parser.add_mutually_exclusive_group()
    shown.add_argument("--json", action="store_true", help="print the report as JSON")
    shown.add_argument(
        "--urdf",
        action="store_true",
        help="print the expanded URDF instead; the report's line numbers are its",
    )


def run(options: argparse.Namespace) -> int:
    """Print the report; return 1 where the robot cannot be simulated."""
    # What is logged besides stands in the report, too.
    logging.getLogger().addHandler(logging.NullHandler())

    from arm_description.errors import DescriptionError
    from arm_description.resources import folders_of
    from arm_description.xacro_arguments import arguments_of_words
    from arm_description.xacro_expansion import expand_xacro_file
    from arm_gazebo.check.description import check_description
    from arm_gazebo.errors import SettingsError
    from arm_gazebo.launching.robot_setup import folders, path_of
    from arm_gazebo.mesh.cache import cache_folder
    from arm_gazebo.robot.build_options import BuildOptions

    try:
        given = folders(options.package_path)
        file = path_of(options.file, given)
        urdf = expand_xacro_file(file, arguments_of_words(options.arguments), given).text
    except (DescriptionError, SettingsError) as error:
        raise ArmCliError(str(error)) from error
    if options.urdf:
        print(urdf)
        return 0
    build = BuildOptions(
        strict=options.strict,
        package_path=(*given, *folders_of(file)),
        mesh_cache=cache_folder(),
    )
    check = check_description(urdf, str(file), build)
    print(_as_json(check) if options.json else _as_text(check))
    return 0 if check.is_usable else EXIT_UNUSABLE


def _as_text(check: "DescriptionCheck") -> str:
    counts = Counter(finding.outcome.value for finding in check.findings)
    width = max(map(len, counts), default=0)
    lines = [] if check.robot is None else [str(check.robot)]
    for finding in check.findings:
        indented = str(finding).replace("\n", f"\n{'':{width + 4}}")
        lines.append(f"  {finding.outcome.value:<{width}}  {indented}")
    total = ", ".join(f"{count} {word}" for word, count in counts.items()) or "nothing to remark"
    return "\n".join([*lines, f"{'usable' if check.is_usable else 'not usable'}: {total}"])


def _as_json(check: "DescriptionCheck") -> str:
    return json.dumps(
        {
            "usable": check.is_usable,
            "robot": None if check.robot is None else asdict(check.robot),
            "findings": [
                {
                    "outcome": finding.outcome.value,
                    "element": finding.element,
                    "line": finding.line,
                    "message": finding.message,
                }
                for finding in check.findings
            ],
        },
        indent=2,
    )
