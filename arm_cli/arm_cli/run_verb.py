"""`arm run` and `arm view`: replace this process by an executable of a package."""

import argparse
import os
import shlex
import sys
from collections.abc import Sequence
from typing import NoReturn

from arm_cli.errors import CommandUsageError, NoSuchNameError
from arm_cli.output import complain
from arm_cli.verb import VerbFunctions
from arm_cli.word_completion import complete_with
from launch_py.errors import LaunchError
from launch_py.system.child_environment import default_environment, for_program
from launch_py.system.packages import Packages

DEFAULT_PORT = 8080


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(parser.add_argument("package_name", help="such as arm_controller"), packages)
    complete_with(
        parser.add_argument("executable_name", help="such as publisher_terminal"), executables
    )
    parser.add_argument("argv", nargs=argparse.REMAINDER, help="its arguments")
    parser.add_argument("--prefix", default="", help="words before the command, such as gdb")


def run(words: Sequence[str]) -> NoReturn:
    """Replace this process by the executable, which gets the words after its name.

    Raises:
        NoSuchNameError: there is no such package or executable; the message suggests similar
            names.
        CommandUsageError: the prefix cannot be started, or a quotation mark in it is not closed.
    """
    from arm_cli.command_parser import CommandParser

    parser = CommandParser("arm run", "Run an executable of a package.")
    add_arguments(parser)
    options = parser.parse_args(words)
    try:
        prefix = shlex.split(options.prefix)
    except ValueError as error:
        raise CommandUsageError(f"--prefix {options.prefix!r}: {error}") from error
    command = find_command(options.package_name, options.executable_name)
    replace_process([*prefix, *command, *options.argv])


def replace_process(command: list[str]) -> NoReturn:
    """Replace this process by a program, in the environment that `arm launch` would give it.

    Raises:
        CommandUsageError: the program cannot be started.
    """
    interactive = sys.stdout.isatty()
    added = default_environment(os.environ, None, None, interactive)
    environment = for_program(command[0], {**os.environ, **added})
    sys.stdout.flush()
    try:
        os.execvpe(command[0], command, environment)
    except OSError as error:
        raise CommandUsageError(f"cannot start {command[0]}: {error.strerror}") from error


def find_command(package: str, name: str) -> tuple[str, ...]:
    """Return the command line of an executable, or of its replacement here.

    Raises:
        NoSuchNameError: there is no such package or executable.
    """
    installed = Packages(os.environ)
    try:
        command = installed.executable(package, name)
    except LaunchError as error:
        raise NoSuchNameError(str(error)) from error
    found = installed.stand_in_of(package, name)
    if found is not None and found.remark:
        complain(found.remark)
    return command


def packages(**_: object) -> list[str]:
    """Return the packages with executables, for the Tab key."""
    return sorted({package for package, _ in Packages(os.environ).executables()})


def executables(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Return the executables of the typed package, for the Tab key."""
    wanted = parsed_args.package_name
    return [name for package, name in Packages(os.environ).executables() if package == wanted]


def add_view_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument(
        "--port",
        type=int,
        default=DEFAULT_PORT,
        help=f"port of the page on 127.0.0.1 (default {DEFAULT_PORT})",
    )
    parser.add_argument(
        "--publish-joint-states",
        action="store_true",
        help="publish joint states from the page's sliders, without a robot",
    )


def view(options: argparse.Namespace) -> NoReturn:
    """Replace this process by the node of the page."""
    publish = "true" if options.publish_joint_states else "false"
    parameters = (f"port:={options.port}", f"publish_joint_states:={publish}")
    words = [word for parameter in parameters for word in ("-p", parameter)]
    replace_process([*find_command("arm_viewer", "arm_viewer_node"), "--ros-args", *words])


VIEW = VerbFunctions(add_view_arguments, view)
