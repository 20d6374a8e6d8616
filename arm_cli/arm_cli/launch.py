"""`arm launch`: the simulated arm, or any launch file, under launch_py's supervisor.

`domain:=NUMBER` or `domain:=auto` among its words is the ROS domain of the launch. A robot or a
world among them, as in `arm launch my_robot.urdf`, is launched as if its launch file were named.
The Tab key completes packages, launch files, launch arguments and their values.
"""

import os
import re
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from arm_cli.arguments import Argument, Flag
from arm_cli.errors import ArmCliError
from arm_cli.output import complain, say
from arm_cli.word_completion import words_before
from arm_node.ros_domain import NoFreeDomainError, describe_users, other_users
from launch_py import LaunchError
from launch_py.command.command_line import find_launch_file
from launch_py.command.command_line import run as run_launch
from launch_py.fast_dds.participants import domain_of
from launch_py.launch_context import ArgumentInfo
from launch_py.launch_description_sources import read_launch_file
from launch_py.system.packages import Packages, ament_prefixes, launch_files

STOP = (sys.executable, "-P", "-m", "arm_cli", "stop")
"""`arm stop`; with -P, a user's yaml.py in the current folder does not take a library's place."""
SHORT_NAMES = {
    "": ("arm_gazebo", "arm_gazebo.launch.py"),
    "mycobot": ("mycobot_gazebo", "mycobot.gazebo.launch.py"),
}
DOMAIN_WORD = "domain:="
AUTO = "auto"
DOMAIN = "ROS_DOMAIN_ID"
ROBOT_LAUNCH = ("arm_gazebo", "sim.launch.py")
FILE_ARGUMENTS = {".urdf": "model", ".xacro": "model", ".sdf": "world", ".world": "world"}
"""The launch argument that takes a file of this ending."""
ROOTS = {"robot": "model", "mujoco": "world", "sdf": "world"}
"""The launch argument that takes an XML file with this root."""
ROOT = re.compile(rb"<([A-Za-z_]\w*)")
LONGEST_HEAD = 10_000
"""In which part of an XML file its root stands, after comments."""
LAUNCH_FILE = re.compile(r"launch(\.(py|xml|yaml|yml))?$")
"""The end of a name that is certainly a launch file's."""
BOOLEANS = ("true", "false")
WORLD = "world"
"""The argument that takes the name of a shipped world, or the path of a file."""


def launch(argv: Sequence[str]) -> int:
    """Launch; return the exit code."""
    # Imported only here, because Tab completion does not need it.
    from launch_py.supervision.foreground import KeyCommand

    try:
        with launch_domain(argv) as words:
            return run_launch(
                name_launch_file(words),
                program="arm launch",
                short_names=SHORT_NAMES,
                before_start=_check_environment,
                key=KeyCommand("emergency stop", STOP),
            )
    except NoFreeDomainError as error:
        raise ArmCliError(str(error)) from error


def _check_environment() -> None:
    """Check the environment before any process starts and fails.

    Raises:
        LaunchError: ROS cannot start in this environment; the message says how to fix it.
    """
    from arm_node.environment import UnusableEnvironmentError, prepare_environment

    try:
        prepare_environment()
    except UnusableEnvironmentError as error:
        raise LaunchError(str(error)) from error
    users = other_users(domain_of(os.environ.get("ROS_DOMAIN_ID")) or 0)
    if users:
        complain(f"[launch] warning: {describe_users(users)}; domain:=auto takes another domain")


@contextmanager
def launch_domain(words: Sequence[str]) -> Iterator[list[str]]:
    """Take `domain:=auto` or `domain:=NUMBER` out of a launch's words, and enter that domain.

    Another value is left to the launch file, which may have an argument of that name. No
    other launch takes a domain that `auto` has found until the `with` block ends.

    Yields:
        The other words.
    """
    values = [word.removeprefix(DOMAIN_WORD) for word in words if word.startswith(DOMAIN_WORD)]
    value = values[-1] if values else ""
    if value != AUTO and not _is_domain(value):
        yield list(words)
        return
    others = [word for word in words if not word.startswith(DOMAIN_WORD)]
    if value != AUTO:
        os.environ[DOMAIN] = value
        yield others
        return
    from arm_node.ros_domain import domain_of_its_own

    with domain_of_its_own() as domain:
        os.environ[DOMAIN] = str(domain)
        say(f"[launch] {DOMAIN}={domain}; export it where you start programs of your own")
        yield others


def _is_domain(text: str) -> bool:
    return text != "" and domain_of(text) is not None


def name_launch_file(words: Sequence[str]) -> list[str]:
    """Return a launch's words with a robot or world file among them as an argument.

    A robot is launched by `sim.launch.py`, a world with the default arm.
    """
    named: list[str] = []
    for word in words:
        argument = "" if word.startswith("-") or ":=" in word else _argument_for(Path(word))
        if argument == "model":
            named += ROBOT_LAUNCH
        named.append(f"{argument}:={word}" if argument else word)
    return named


def _argument_for(path: Path) -> str:
    """Return the launch argument that takes a file, "" if none does."""
    if path.suffix != ".xml" or not path.is_file():
        return FILE_ARGUMENTS.get(path.suffix, "")
    try:
        with path.open("rb") as file:
            head = file.read(LONGEST_HEAD)
    except OSError:
        return ""  # The launcher reports it.
    root = ROOT.search(re.sub(rb"<!--.*?-->", b"", head, flags=re.DOTALL))
    return ROOTS.get(root[1].decode(), "") if root else ""


def launch_words(prefix: str, **_: Any) -> list[str]:
    """Return the words that can come next after `arm launch`."""
    typed = [word for word in words_before(2) if not word.startswith("-") and ":=" not in word]
    name, separator, value = prefix.partition(":=")
    arguments = _arguments(typed)
    if separator:
        known = next((each for each in arguments if each.name == name), None)
        return [] if known is None else [f"{name}:={word}" for word in _values(known, value)]
    offered = [f"{argument.name}:=" for argument in arguments]
    match typed:
        case []:
            files = [path for path in _launch_files(Path(prefix)) if path.startswith(prefix)]
            return [*filter(None, SHORT_NAMES), *_packages(), *files, *offered]
        case [package] if not offered:
            return sorted(_files_of(package))
    return offered


def _arguments(typed: Sequence[str]) -> Sequence[ArgumentInfo]:
    """Return the arguments of the launch file that the words name, empty if they name none."""
    from launch_py.launch_description import survey_description

    try:
        path = find_launch_file(typed, SHORT_NAMES)
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


ARGUMENTS = (
    Argument("words", nargs="*", completer=launch_words),
    Flag("-s", "--show-args"),
    Flag("-p", "--print"),
    Flag("-d", "--debug"),
    Flag("-a", "--show-all-subprocesses-output"),
)
"""For the Tab key only; launch_py parses the words itself."""
