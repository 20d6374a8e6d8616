"""`arm control load_controller`: load a controller, and configure and activate it if asked to."""

import argparse

from arm_cli.control.manager import add_manager_arguments, ask_manager, refuse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("controller_name", help="one that the manager's parameters describe")
    parser.add_argument(
        "--set-state", choices=("inactive", "active"), help="bring it to that state, too"
    )
    add_manager_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Load the controller; the exit code is 1 where a step fails.

    Raises:
        UnansweredError: the manager does not answer.
    """
    name, state = options.controller_name, options.set_state
    with ask_manager(options) as manager:
        if not manager.load(name):
            return refuse(f"Failed loading controller {name} check controller_manager logs")
        if state is None:
            print(f"Successfully loaded controller {name}")
            return 0
        if not manager.configure(name):
            return refuse(f"Failed configuring controller {name} check controller_manager logs")
        if state == "active" and not manager.switch(activate=[name]).ok:
            return refuse(f"Error activating controller {name}, check controller_manager logs")
    print(f"Successfully loaded controller {name} into state {state}")
    return 0
