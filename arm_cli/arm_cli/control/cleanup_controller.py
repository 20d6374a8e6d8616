"""`arm control cleanup_controller`: take a controller back to unconfigured."""

import argparse

from arm_cli.control.controller_argument import add_controller_argument
from arm_cli.control.manager import add_manager_arguments, ask_manager, refuse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_controller_argument(parser)
    add_manager_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Clean the controller up; the exit code is 1 where that fails.

    Raises:
        UnansweredError: the manager does not answer.
    """
    name = options.controller_name
    with ask_manager(options) as manager:
        if not manager.cleanup(name):
            return refuse("Error cleanup controllers, check controller_manager logs")
    print(f"Successfully cleaned up controller {name}")
    return 0
