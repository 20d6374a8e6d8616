"""`arm run`: an executable of a package, in place of this process."""

import argparse
import os
import shlex
import sys
from collections.abc import Sequence
from typing import NoReturn

from arm_cli.errors import NotFoundError, UsageError
from arm_cli.word_completion import complete_with
from launch_py.child_environment import default_environment, for_program
from launch_py.errors import LaunchError
from launch_py.packages import Packages

COURSE_EXECUTABLES: dict[tuple[str, str], tuple[str, str, tuple[str, ...]]] = {
    ("arm_control", "arm_controller"): (
        "arm_controller",
        "arm_controller_node",
        ("--ros-args", "-p", "desired_param:=[1.0, 0.5, 0.1, 0.5]"),
    ),
    ("arm_control", "publisher_terminal"): ("arm_controller", "publisher_terminal", ()),
    ("arm_control", "publisher_defined"): ("arm_controller", "publisher_defined", ()),
    ("mycobot_system_tests", "arm_gripper_loop_controller"): (
        "arm_controller",
        "arm_gripper_loop_controller",
        (),
    ),
    ("mycobot_system_tests", "arm_gripper_loop_controller.py"): (
        "arm_controller",
        "arm_gripper_loop_controller",
        (),
    ),
    ("gz_ros2_control_demos", "example_gripper"): ("arm_controller", "example_gripper", ()),
    ("gz_ros2_control_demos", "example_diff_drive"): ("arm_controller", "example_diff_drive", ()),
}
"""Executables of the course project, by package and name there: what does the same here."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(parser.add_argument("package_name", help="such as arm_controller"), packages)
    complete_with(
        parser.add_argument("executable_name", help="such as publisher_terminal"), executables
    )
    parser.add_argument("argv", nargs=argparse.REMAINDER, help="its arguments")
    parser.add_argument("--prefix", default="", help="put before it, such as 'gdb -ex run --args'")


def run(words: Sequence[str]) -> NoReturn:
    """Become the executable; what follows its name is passed on to it.

    Raises:
        NotFoundError: there is no such package or executable; the message names near ones.
        UsageError: the prefix cannot be started, or a quotation in it has no end.
    """
    from arm_cli.command_parser import CommandParser

    parser = CommandParser("arm run", "Run an executable of a package.")
    add_arguments(parser)
    options = parser.parse_args(words)
    try:
        prefix = shlex.split(options.prefix)
    except ValueError as error:
        raise UsageError(f"--prefix {options.prefix!r}: {error}") from error
    command = find_command(options.package_name, options.executable_name)
    become([*prefix, *command, *options.argv])


def become(command: list[str]) -> NoReturn:
    """Put a program with its arguments in this process's place, as `arm launch` would start it.

    Raises:
        UsageError: it cannot be started.
    """
    interactive = sys.stdout.isatty()
    added = default_environment(os.environ, None, None, interactive)
    environment = for_program(command[0], {**os.environ, **added})
    sys.stdout.flush()
    try:
        os.execvpe(command[0], command, environment)
    except OSError as error:
        raise UsageError(f"cannot start {command[0]}: {error.strerror}") from error


def find_command(package: str, name: str) -> tuple[str, ...]:
    """Return the command line of an executable, by its name here or in a course project.

    Raises:
        NotFoundError: there is no such package or executable.
    """
    installed = Packages(os.environ)
    candidates: list[tuple[str, str, tuple[str, ...]]] = [(package, name, ())]
    if (package, name) in COURSE_EXECUTABLES:
        candidates.append(COURSE_EXECUTABLES[package, name])
    errors: list[LaunchError] = []
    for home, here, arguments in candidates:
        try:
            return (*installed.executable(home, here), *arguments)
        except LaunchError as error:
            errors.append(error)
    raise NotFoundError(str(errors[0])) from errors[0]


def packages(**_: object) -> list[str]:
    """Return the packages with executables, for the Tab key."""
    return sorted({package for package, _ in Packages(os.environ).executables()})


def executables(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Return the executables of the package that was typed, for the Tab key."""
    wanted = parsed_args.package_name
    return [name for package, name in Packages(os.environ).executables() if package == wanted]
