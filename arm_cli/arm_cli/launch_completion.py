"""Tab completion of `arm launch`: packages, launch files, launch arguments and their values."""

import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from arm_cli.word_completion import words_before
from launch_py import LaunchError
from launch_py.command.command_line import PackagedFile, find_launch_file
from launch_py.launch_description_entity import ArgumentInfo
from launch_py.launch_description_sources import read_launch_file
from launch_py.system.packages import Packages, ament_prefixes, launch_files

LAUNCH_FILE = re.compile(r"launch(\.(py|xml|yaml|yml))?$")
"""The end of a name that is certainly a launch file's."""
BOOLEANS = ("true", "false")
WORLD = "world"
"""The argument that takes the name of a shipped world, or the path of a file."""


def launch_words(prefix: str, short_names: dict[str, PackagedFile], **_: Any) -> list[str]:
    """Return the words that can come next after `arm launch`."""
    typed = [word for word in words_before(2) if not word.startswith("-") and ":=" not in word]
    name, separator, value = prefix.partition(":=")
    arguments = _arguments(typed, short_names)
    if separator:
        known = next((each for each in arguments if each.name == name), None)
        return [] if known is None else [f"{name}:={word}" for word in _values(known, value)]
    offered = [f"{argument.name}:=" for argument in arguments]
    match typed:
        case []:
            files = [path for path in _launch_files(Path(prefix)) if path.startswith(prefix)]
            return [*filter(None, short_names), *_packages(), *files, *offered]
        case [package] if not offered:
            return sorted(_files_of(package))
    return offered


def _arguments(
    typed: Sequence[str], short_names: dict[str, PackagedFile]
) -> Sequence[ArgumentInfo]:
    """Return the arguments of the launch file that the words name, empty if they name none."""
    from launch_py.launch_description import survey_description

    try:
        path = find_launch_file(typed, short_names)
        os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join(ament_prefixes(os.environ))
        survey = survey_description(read_launch_file(path), dict(os.environ), path)
    except LaunchError:
        return ()
    return tuple(survey.arguments.values())


def _values(argument: ArgumentInfo, typed: str) -> Sequence[str]:
    if argument.choices:
        return argument.choices
    default = argument.default
    if default in BOOLEANS:
        return BOOLEANS
    if os.sep in typed:
        return [f"{entry}{os.sep if entry.is_dir() else ''}" for entry in _entries(Path(typed))]
    if argument.name == WORLD:
        from arm_gazebo.launching.world_path import shipped_worlds

        return list(shipped_worlds())
    # A default that the launch file computes is listed as an expression, which is not a value.
    return (default,) if default and "(" not in default else ()


def _packages() -> list[str]:
    """Return the packages that have launch files."""
    packages = Packages(os.environ)
    return [name for name in packages.names() if any(_files_of(name))]


def _files_of(package: str) -> list[str]:
    try:
        share = Packages(os.environ).share_folder(package)
    except LaunchError:
        return []
    return launch_files(share / "launch")


def _launch_files(prefix: Path) -> list[str]:
    """Return the launch files and folders that may complete a typed path."""
    entries = _entries(prefix)
    files = [str(path) for path in entries if LAUNCH_FILE.search(path.name)]
    # Without a slash the first word is a package; a user who types a slash means a folder.
    folders = [f"{path}/" for path in entries if os.sep in str(prefix) and path.is_dir()]
    return [*files, *folders]


def _entries(typed: Path) -> list[Path]:
    """Return the files and folders that may complete a typed path."""
    folder = typed if typed.is_dir() else typed.parent
    try:
        return sorted(folder.iterdir())
    except OSError:
        return []
