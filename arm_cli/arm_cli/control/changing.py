"""The verbs of `arm control` that change controllers or hardware components."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from arm_cli.arguments import Argument, Exclusive, Flag, positive_number, verb
from arm_cli.control.manager import (
    CONTROLLER,
    MANAGER,
    ask_manager,
    hardware_components,
    loadable_controllers,
    loaded_controllers,
    refuse,
    suggestion,
)
from arm_cli.names import absolute_name
from arm_cli.output import complain, say, say_document

if TYPE_CHECKING:
    from arm_node.controller_manager import ControllerManagerClient

DEFAULT, BEST_EFFORT, STRICT = 0, 1, 2
"""Strictness as in controller_manager_msgs/srv/SwitchController; 0 leaves it to the manager."""
_FAILING = {  # The words of ros2 control, which calls every step to inactive "stopping".
    "unconfigured": "cleaning up",
    "inactive": "stopping",
    "active": "activating",
}


@verb(
    Argument(
        "controller_name",
        help="a controller in the manager's parameters",
        completer=loadable_controllers,
    ),
    Argument("param_file", nargs="?", help="YAML file with the controller's parameters and type"),
    Argument("--set-state", choices=("inactive", "active"), help="also bring it to this state"),
    *MANAGER,
)
def load_controller(options: argparse.Namespace) -> int:
    """Load the controller; the exit code is 1 if a step fails."""
    name, state = options.controller_name, options.set_state
    with ask_manager(options) as manager:
        if name in manager.states():
            say(f"Controller : {name} already loaded, skipping load_controller!")
        elif refusal := _give_parameters(manager, options):
            return refuse(refusal)
        elif manager.load(name):
            say(f"Successfully loaded controller {name}")
        else:
            hint = suggestion(name, manager.loadable())
            return refuse(f"Failed loading controller {name} check controller_manager logs{hint}")
        if state is None:
            return 0
        if not manager.configure(name):
            return refuse(f"Error configuring controller : {name}")
        if state == "active" and not manager.switch(activate=[name]).ok:
            return refuse(f"Error activating controller : {name}, check controller_manager logs")
    say(f"Successfully loaded controller {name} into state {state}")
    return 0


def _give_parameters(manager: "ControllerManagerClient", options: argparse.Namespace) -> str:
    """Tell the manager the controller's parameter file and type; return why it refuses, or ""."""
    if options.param_file is None:
        return ""
    if not Path(options.param_file).exists():
        return f"Controller parameter file : {options.param_file} does not exist, Aborting!"
    # Imported here, because the other verbs do without it.
    from arm_control.errors import ParameterError
    from arm_control.manager.parameter_file import ControllerParameterFile, manager_parameters

    namespace = absolute_name(options.controller_manager).rpartition("/")[0] or "/"
    try:
        file = ControllerParameterFile(options.param_file)
        parameters = manager_parameters(options.controller_name, namespace, [file])
    except ParameterError as error:
        return str(error)
    return manager.set_parameters(parameters) if parameters else ""


@verb(CONTROLLER, *MANAGER)
def unload_controller(options: argparse.Namespace) -> int:
    """Unload the controller; the exit code is 1 if that fails."""
    name = options.controller_name
    with ask_manager(options) as manager:
        if not manager.unload(name):
            hint = suggestion(name, manager.states())
            return refuse(f"Error unloading controller {name}, check controller_manager logs{hint}")
    say(f"Successfully unloaded controller {name}")
    return 0


@verb(CONTROLLER, *MANAGER)
def cleanup_controller(options: argparse.Namespace) -> int:
    """Clean up the controller; the exit code is 1 if that fails."""
    name = options.controller_name
    with ask_manager(options) as manager:
        if not manager.cleanup(name):
            hint = suggestion(name, manager.states())
            return refuse(
                f"Error cleaning up controller {name}, check controller_manager logs{hint}"
            )
    say(f"Successfully cleaned up controller {name}")
    return 0


@verb(CONTROLLER, Argument("state", choices=("unconfigured", "inactive", "active")), *MANAGER)
def set_controller_state(options: argparse.Namespace) -> int:
    """Bring the controller to the state; the exit code is 1 if that fails."""
    name = options.controller_name
    with ask_manager(options) as manager:
        states = manager.states()
        if name not in states:
            hint = suggestion(name, states)
            return refuse(f"controller {name} does not seem to be loaded{hint}")
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
    say(f"Successfully {done} {name}")
    return 0


def _impossible(name: str, current: str, wanted: str) -> str:
    action = {"unconfigured": f"cleanup {name}", "active": f"activate {name}"}.get(
        wanted, f"put {name} in 'inactive' state"
    )
    return f"cannot {action} from its current state {current}"


@verb(
    *(
        Argument(option, nargs="*", default=[], metavar="CONTROLLER", completer=loaded_controllers)
        for option in ("--deactivate", "--activate")
    ),
    Exclusive(
        Flag("--strict", help="all or nothing"),
        Flag("--best-effort", help="as many as possible"),
    ),
    Flag("--activate-asap", help="passed on to the controller manager"),
    Argument("--switch-timeout", type=positive_number, default=5.0, metavar="SECONDS"),
    *MANAGER,
)
def switch_controllers(options: argparse.Namespace) -> int:
    """Switch controllers; the exit code is 1 if the manager refuses."""
    strictness = STRICT if options.strict else BEST_EFFORT if options.best_effort else DEFAULT
    with ask_manager(options) as manager:
        response = manager.switch(
            options.activate,
            options.deactivate,
            strictness=strictness,
            asap=options.activate_asap,
            timeout_s=options.switch_timeout,
        )
        if not response.ok:
            loaded = manager.states()
            hints = [suggestion(name, loaded) for name in (*options.activate, *options.deactivate)]
            for hint in filter(None, hints):
                complain(f"arm control switch_controllers{hint.replace(';', ':', 1)}")
    outcome = "Successfully switched controllers!" if response.ok else "Error switching controllers"
    say_document(response.message or outcome)
    return 0 if response.ok else 1


@verb(Flag("--force-kill", help="deactivate and unload controllers first"), *MANAGER)
def reload_controller_libraries(options: argparse.Namespace) -> int:
    """Reload the controllers' code; the exit code is 1 if that fails."""
    with ask_manager(options) as manager:
        if not manager.reload_libraries(options.force_kill):
            return refuse("Error reloading libraries, check controller_manager logs")
    say("Reload successful")
    return 0


@verb(
    Argument(
        "hardware_component_name",
        help="as list_hardware_components lists it",
        completer=hardware_components,
    ),
    Argument("state", choices=tuple(_FAILING)),
    *MANAGER,
)
def set_hardware_component_state(options: argparse.Namespace) -> int:
    """Set the component's state; the exit code is 1 if that fails."""
    name, state = options.hardware_component_name, options.state
    with ask_manager(options) as manager:
        response = manager.set_component_state(name, state)
        if not response.ok:
            hint = suggestion(name, [c.name for c in manager.hardware_components()])
            return refuse(
                f"Error {_FAILING[state]} hardware component, check controller_manager logs{hint}"
            )
    say(f"Successfully set {name} to state {response.state}")
    return 0
