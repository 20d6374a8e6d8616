"""`arm control unload_controller`: unload a controller."""

import argparse

from arm_cli.control.controller_argument import add_controller_argument
from arm_cli.control.manager import add_manager_arguments, ask_manager, refuse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_controller_argument(parser)
    add_manager_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Unload the controller; the exit code is 1 where that fails.

    Raises:
        UnansweredError: the manager does not answer.
    """
    name = options.controller_name
    with ask_manager(options) as manager:
        if not manager.unload(name):
            return refuse(f"Error unloading controller {name}, check controller_manager logs")
    print(f"Successfully unloaded controller {name}")
    return 0
