"""`arm launch`: the simulated arm, or any launch file, under launch_py's supervisor."""

import argparse
import os
import sys
from collections.abc import Sequence
from functools import partial

from arm_cli.errors import ArmCliError
from arm_cli.launch_domain import launch_domain
from arm_cli.launch_model import name_launch_file
from arm_cli.output import complain
from arm_cli.word_completion import complete_with
from arm_node.ros_domain import NoFreeDomainError, describe_users, other_users
from launch_py import LaunchError
from launch_py.command.command_line import run as run_launch
from launch_py.fast_dds.participants import domain_of

STOP = (sys.executable, "-P", "-m", "arm_cli", "stop")
"""`arm stop`; with -P, a user's yaml.py in the current folder does not take a library's place."""
SHORT_NAMES = {
    "": ("arm_gazebo", "arm_gazebo.launch.py"),
    "mycobot": ("mycobot_gazebo", "mycobot.gazebo.launch.py"),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments for Tab completion only; launch_py parses the words itself."""
    from arm_cli.launch_completion import launch_words

    complete_with(
        parser.add_argument("words", nargs="*"), partial(launch_words, short_names=SHORT_NAMES)
    )
    for options in (("-s", "--show-args"), ("-p", "--print"), ("-d", "--debug")):
        parser.add_argument(*options, action="store_true")
    parser.add_argument("-a", "--show-all-subprocesses-output", action="store_true")


def run(argv: Sequence[str]) -> int:
    """Launch; return the exit code."""
    # Imported only here, because Tab completion does not need it.
    from launch_py.supervision.terminal_key import KeyCommand

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
