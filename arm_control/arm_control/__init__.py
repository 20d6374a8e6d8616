"""ros2_control in Python: hardware interface, controller manager, controllers and spawner.

This package exports what you need to write your own controller or hardware component.
`arm_control.testing` has fakes to test them with.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from arm_control.controllers.controller import (
        ChainableController,
        Controller,
        ControllerContext,
        InterfaceConfiguration,
        NoParameters,
        ReturnType,
    )
    from arm_control.errors import ArmControlError, ControllerError, ControllerManagerError
    from arm_control.hardware.driver import Hardware, HardwareReturn, SystemInterface
    from arm_control.hardware.info import (
        HardwareInfo,
        InterfaceInfo,
        JointInfo,
        parse_hardware_info,
    )
    from arm_control.hardware.joint_limits import JointLimits, SoftLimits, read_joint_limits
    from arm_control.lifecycle import LifecycleState, Transition
    from arm_control.loop.control_loop import ControlLoop
    from arm_control.loop.pacer import Pacer, PacerStatistics
    from arm_control.manager.controller_manager import ControllerManager, ManagerObserver
    from arm_control.manager.settings import ManagerPolicy
    from arm_control.manager.switch_planner import Strictness, SwitchRequest, SwitchResult
    from arm_control.parameters import parameter
    from arm_control.run_inputs import run_input

__all__ = [
    "ArmControlError",
    "ChainableController",
    "ControlLoop",
    "Controller",
    "ControllerContext",
    "ControllerError",
    "ControllerManager",
    "ControllerManagerError",
    "Hardware",
    "HardwareInfo",
    "HardwareReturn",
    "InterfaceConfiguration",
    "InterfaceInfo",
    "JointInfo",
    "JointLimits",
    "LifecycleState",
    "ManagerObserver",
    "ManagerPolicy",
    "NoParameters",
    "Pacer",
    "PacerStatistics",
    "ReturnType",
    "SoftLimits",
    "Strictness",
    "SwitchRequest",
    "SwitchResult",
    "SystemInterface",
    "Transition",
    "parameter",
    "parse_hardware_info",
    "read_joint_limits",
    "run_input",
]

_EXPORTS = {
    "controllers.controller": (
        "ChainableController",
        "Controller",
        "ControllerContext",
        "InterfaceConfiguration",
        "NoParameters",
        "ReturnType",
    ),
    "errors": ("ArmControlError", "ControllerError", "ControllerManagerError"),
    "hardware.driver": ("Hardware", "HardwareReturn", "SystemInterface"),
    "hardware.info": ("HardwareInfo", "InterfaceInfo", "JointInfo", "parse_hardware_info"),
    "hardware.joint_limits": ("JointLimits", "SoftLimits", "read_joint_limits"),
    "lifecycle": ("LifecycleState", "Transition"),
    "loop.control_loop": ("ControlLoop",),
    "loop.pacer": ("Pacer", "PacerStatistics"),
    "manager.controller_manager": ("ControllerManager", "ManagerObserver"),
    "manager.settings": ("ManagerPolicy",),
    "manager.switch_planner": ("Strictness", "SwitchRequest", "SwitchResult"),
    "parameters": ("parameter",),
    "run_inputs": ("run_input",),
}
_MODULE_OF = {name: module for module, names in _EXPORTS.items() for name in names}


def __getattr__(name: str) -> Any:
    # A public name is imported on first use: a spawner runs for half a second and needs neither
    # numpy nor the robot description, and importing those takes as long again.
    if name not in _MODULE_OF:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    value = getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
