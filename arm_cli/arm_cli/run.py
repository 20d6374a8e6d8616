"""`arm run` and `arm view`: replace this process by an executable of a package."""

import argparse
import json
import os
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

from arm_cli.arguments import Argument, CommandParser, Flag, verb
from arm_cli.errors import CommandUsageError, NoSuchNameError
from arm_cli.output import complain
from launch_py.errors import LaunchError
from launch_py.system.child_environment import default_environment, for_program
from launch_py.system.packages import Packages

DEFAULT_PORT = 8080
LOCAL_HOST = "127.0.0.1"


def packages(**_: object) -> list[str]:
    """Return the packages with executables, for the Tab key."""
    return sorted({package for package, _ in Packages(os.environ).executables()})


def executables(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Return the executables of the typed package, for the Tab key."""
    wanted = parsed_args.package_name
    return [name for package, name in Packages(os.environ).executables() if package == wanted]


ARGUMENTS = (
    Argument("package_name", completer=packages, help="such as arm_controller"),
    Argument("executable_name", completer=executables, help="such as publisher_terminal"),
    Argument("argv", nargs=argparse.REMAINDER, help="its arguments"),
    Argument("--prefix", default="", help="words before the command, such as gdb"),
)


def run(words: Sequence[str]) -> NoReturn:
    """Replace this process by the executable, which gets the words after its name.

    Raises:
        NoSuchNameError: there is no such package or executable; the message suggests similar
            names.
        CommandUsageError: the prefix cannot be started, or a quotation mark in it is not closed.
    """
    parser = CommandParser("arm run", "Run an executable of a package.")
    for argument in ARGUMENTS:
        argument.add_to(parser)
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


@verb(
    Argument(
        "recording",
        nargs="?",
        type=Path,
        metavar="RECORDING",
        help="bag or run to show first: a folder or an .mcap file, or a file of arm sim record, "
        "which is verified; no simulation is needed",
    ),
    Argument(
        "--recordings",
        type=Path,
        metavar="DIR",
        help="folder of the recordings that the page lists and makes (default: this one)",
    ),
    Argument(
        "--port",
        type=int,
        default=DEFAULT_PORT,
        help=f"port of the page (default {DEFAULT_PORT})",
    ),
    Argument(
        "--host",
        metavar="ADDRESS",
        default=LOCAL_HOST,
        help=f"address to listen on (default {LOCAL_HOST}: this machine alone); 0.0.0.0 serves "
        "other machines, to browsers that open the address with the token that is printed",
    ),
    Flag("--read-only", help="let nobody do more than look; otherwise a second token does that"),
    Flag(
        "--publish-joint-states",
        help="publish joint states from the page's sliders, without a robot",
    ),
)
def view(options: argparse.Namespace) -> NoReturn:
    """Replace this process by the node of the page."""
    # A number would not be a string of ROS.
    parameters = [f"port:={options.port}", f"host:='{options.host}'"]
    parameters += ["publish_joint_states:=true"] * options.publish_joint_states
    parameters += ["read_only:=true"] * options.read_only
    # As JSON, so that a name such as 1.0 stays a text.
    paths = {"recordings": options.recordings, "recording": options.recording}
    parameters += [f"{n}:={json.dumps(str(path))}" for n, path in paths.items() if path]
    words = [word for parameter in parameters for word in ("-p", parameter)]
    replace_process([*find_command("arm_viewer", "arm_viewer_node"), "--ros-args", *words])
