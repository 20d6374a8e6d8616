"""`arm control reload_controller_libraries`: read the controllers' code anew."""

import argparse

from arm_cli.control.manager import add_manager_arguments, ask_manager, refuse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument(
        "--force-kill", action="store_true", help="deactivate and unload controllers first"
    )
    add_manager_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Reload; the exit code is 1 where that fails.

    Raises:
        UnansweredError: the manager does not answer.
    """
    with ask_manager(options) as manager:
        if not manager.reload_libraries(options.force_kill):
            return refuse("Error reloading libraries, check controller_manager logs")
    print("Reload successful")
    return 0
