"""ros2_control in Python: hardware interface, controller manager, controllers and spawner.

What a controller or a hardware component of your own needs is here; `arm_control.testing` has
the fakes to test it with, and `arm_control.ros` the ROS side.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from arm_control.chainable_controller import ChainableController
    from arm_control.control_loop import ControlLoop
    from arm_control.controller import Controller, ControllerContext, NoParameters, ReturnType
    from arm_control.controller_manager import ControllerManager, ManagerObserver
    from arm_control.controller_switch import Strictness, SwitchRequest, SwitchResult
    from arm_control.errors import ArmControlError, ControllerError, ControllerManagerError
    from arm_control.hardware import Hardware, HardwareReturn
    from arm_control.hardware_info import (
        HardwareInfo,
        InterfaceInfo,
        JointInfo,
        parse_hardware_info,
    )
    from arm_control.interface_configuration import InterfaceConfiguration
    from arm_control.joint_limits import JointLimits, SoftLimits, read_joint_limits
    from arm_control.lifecycle import LifecycleState, Transition
    from arm_control.manager_policy import ManagerPolicy
    from arm_control.pacer import Pacer, PacerStatistics
    from arm_control.parameters import parameter
    from arm_control.system_interface import SystemInterface

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
]

_HOMES = {
    "chainable_controller": ("ChainableController",),
    "control_loop": ("ControlLoop",),
    "controller": ("Controller", "ControllerContext", "NoParameters", "ReturnType"),
    "controller_manager": ("ControllerManager", "ManagerObserver"),
    "controller_switch": ("Strictness", "SwitchRequest", "SwitchResult"),
    "errors": ("ArmControlError", "ControllerError", "ControllerManagerError"),
    "hardware": ("Hardware", "HardwareReturn"),
    "hardware_info": ("HardwareInfo", "InterfaceInfo", "JointInfo", "parse_hardware_info"),
    "interface_configuration": ("InterfaceConfiguration",),
    "joint_limits": ("JointLimits", "SoftLimits", "read_joint_limits"),
    "lifecycle": ("LifecycleState", "Transition"),
    "manager_policy": ("ManagerPolicy",),
    "pacer": ("Pacer", "PacerStatistics"),
    "parameters": ("parameter",),
    "system_interface": ("SystemInterface",),
}
_HOME_OF = {name: module for module, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> Any:
    # A public name is imported when it is first used: a spawner lives for half a second and needs
    # neither numpy nor the robot's description, which take as long to import.
    if name not in _HOME_OF:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    value = getattr(import_module(f"{__name__}.{_HOME_OF[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
