"""The child process of `arm check`: `python -m arm_cli.check_process`.

A xacro file is a program, so it runs in a process of its own with limited memory. The parent
process limits its time.
"""

import argparse
import json
import logging
import os
import resource
import sys
from collections import Counter
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from arm_cli.errors import ArmCliError
from arm_gazebo.build_report import shown
from arm_node.printable import printable, printable_message

if TYPE_CHECKING:
    from arm_description.package_search import PackagePlace
    from arm_gazebo.check.description import CheckResult

EXIT_UNUSABLE = 1


def main() -> None:
    """Read the options of the check from the first argument, as JSON; print the answer as JSON."""
    # The output of xacro must not mix with the answer.
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "w", encoding="utf-8")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    options = argparse.Namespace(**json.loads(sys.argv[1]))
    # The limit includes the interpreter and its libraries.
    limit = int(options.memory_limit * 1e6)
    resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
    answer: dict[str, object] = {}
    try:
        text, code = check(options)
        answer = {"text": text, "code": code}
    except ArmCliError as error:
        answer = {"error": str(error)}
    except MemoryError:
        answer = {"out_of_memory": True}
    json.dump(answer, answers)
    answers.flush()


def check(options: argparse.Namespace) -> tuple[str, int]:
    """Return the report and the exit code, 1 if the robot or world cannot be simulated.

    Raises:
        ArmCliError: the file does not exist or cannot be read.
    """
    # The report already contains everything that would be logged.
    logging.getLogger().addHandler(logging.NullHandler())

    from arm_description.errors import DescriptionError
    from arm_description.resources import ResourceFinder
    from arm_description.xacro.expansion import arguments_of_words, expand_xacro_file
    from arm_gazebo.check.description import check_description
    from arm_gazebo.check.world import check_world_file, is_world
    from arm_gazebo.errors import SimSettingsError
    from arm_gazebo.launching.robot_setup import folders, path_of
    from arm_gazebo.mesh.cache import cache_folder
    from arm_gazebo.robot.part import BuildOptions

    try:
        given = folders(options.package_path)
        file = path_of(options.file, ResourceFinder(None, given))
        if is_world(file):
            return _show("world", check_world_file(file), options.json)
        expansion = expand_xacro_file(file, arguments_of_words(options.arguments), given)
    except (DescriptionError, SimSettingsError) as error:
        raise ArmCliError(str(error)) from error
    if options.urdf:
        return expansion.text, 0
    build = BuildOptions(
        strict=options.strict,
        resources=expansion.finder,
        mesh_cache=cache_folder(),
    )
    result = check_description(expansion.text, expansion.source, build)
    return _show("robot", result, options.json)


def _show(kind: str, check: "CheckResult[Any]", as_json: bool) -> tuple[str, int]:
    text = _as_json(kind, check) if as_json else _as_text(check)
    return text, 0 if check.is_usable else EXIT_UNUSABLE


def _places(check: "CheckResult[Any]") -> list[tuple[str, "PackagePlace"]]:
    """Return the packages that a robot's description names, with the place of each."""
    return [(name, place) for name, places in check.packages.items() for place in places]


def _as_text(check: "CheckResult[Any]") -> str:
    counts = Counter(finding.outcome.value for finding in check.findings)
    width = max(map(len, counts), default=0)
    lines = [] if check.summary is None else [printable(str(check.summary))]
    lines += [
        printable(f"package '{name}': {place.folder} ({place.origin})")
        for name, place in _places(check)
    ]
    for finding in shown(check.findings):
        indented = printable_message(str(finding)).replace("\n", f"\n{'':{width + 4}}")
        lines.append(f"  {finding.outcome.value:<{width}}  {indented}")
    total = ", ".join(_counted(count, word) for word, count in counts.items()) or "no findings"
    return "\n".join([*lines, f"{'usable' if check.is_usable else 'not usable'}: {total}"])


def _counted(count: int, word: str) -> str:
    return (
        f"{count} {word}s"
        if count > 1 and word in ("note", "warning", "error")
        else f"{count} {word}"
    )


def _as_json(kind: str, check: "CheckResult[Any]") -> str:
    return json.dumps(
        {
            "usable": check.is_usable,
            kind: None if check.summary is None else asdict(check.summary),
            "packages": [
                {"name": name, "folder": str(place.folder), "origin": place.origin}
                for name, place in _places(check)
            ],
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
    ).replace("\x7f", "\\u007f")


if __name__ == "__main__":
    main()
