"""`arm control set_controller_state`: one step of a controller's lifecycle."""

import argparse
from typing import TYPE_CHECKING

from arm_cli.control.controller_argument import add_controller_argument
from arm_cli.control.manager import add_manager_arguments, ask_manager, refuse

if TYPE_CHECKING:
    from arm_cli.ros.controller_manager import ControllerManagerClient


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_controller_argument(parser)
    parser.add_argument("state", choices=("unconfigured", "inactive", "active"))
    add_manager_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Bring the controller to the state; the exit code is 1 where that fails.

    Raises:
        UnansweredError: the manager does not answer.
    """
    name = options.controller_name
    with ask_manager(options) as manager:
        states = {controller.name: controller.state for controller in manager.controllers()}
        if name not in states:
            return refuse(f"controller {name} does not seem to be loaded")
        return _step(manager, name, states[name], options.state)


def _step(manager: "ControllerManagerClient", name: str, current: str, wanted: str) -> int:
    match current, wanted:
        case "inactive", "unconfigured":
            failing, done, ok = "cleaning up", "cleaned up", manager.cleanup(name)
        case "unconfigured", "inactive":
            failing, done, ok = "configuring", "configured", manager.configure(name)
        case "active", "inactive":
            failing, done, ok = "stopping", "deactivated", manager.switch(deactivate=[name]).ok
        case "inactive", "active":
            failing, done, ok = "activating", "activated", manager.switch(activate=[name]).ok
        case _:
            return refuse(_impossible(name, current, wanted))
    if not ok:
        return refuse(f"Error {failing} controller, check controller_manager logs")
    print(f"Successfully {done} {name}")
    return 0


def _impossible(name: str, current: str, wanted: str) -> str:
    action = {"unconfigured": f"cleanup {name}", "active": f"activate {name}"}.get(
        wanted, f"put {name} in 'inactive' state"
    )
    return f"cannot {action} from its current state {current}"
