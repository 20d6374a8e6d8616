"""`arm control set_hardware_component_state`: bring a hardware component to a state."""

import argparse

from arm_cli.control.manager import add_manager_arguments, ask_manager, refuse

_FAILING = {"unconfigured": "cleaning up", "inactive": "configuring", "active": "activating"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("hardware_component_name", help="as list_hardware_components has it")
    parser.add_argument("state", choices=tuple(_FAILING))
    add_manager_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Set the state; the exit code is 1 where that fails.

    Raises:
        UnansweredError: the manager does not answer.
    """
    name, state = options.hardware_component_name, options.state
    with ask_manager(options) as manager:
        response = manager.set_component_state(name, state)
    if not response.ok:
        return refuse(f"Error {_FAILING[state]} hardware component, check controller_manager logs")
    print(f"Successfully set {name} to state {response.state}")
    return 0
