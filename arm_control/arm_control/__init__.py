"""ros2_control in Python: hardware interface, controller manager, controllers and spawner.

What a controller or a hardware component of your own needs is here; `arm_control.testing` has
the fakes to test it with, and `arm_control.ros` the ROS side.
"""

from arm_control.control_loop import ControlLoop
from arm_control.controller import Controller, ControllerContext, NoParameters, ReturnType
from arm_control.controller_manager import ControllerManager, ManagerObserver
from arm_control.controller_switch import Strictness, SwitchRequest, SwitchResult
from arm_control.errors import ArmControlError, ControllerError, ControllerManagerError
from arm_control.hardware import Hardware, HardwareReturn
from arm_control.hardware_info import HardwareInfo, InterfaceInfo, JointInfo, parse_hardware_info
from arm_control.interface_configuration import InterfaceConfiguration
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.pacer import Pacer, PacerStatistics
from arm_control.parameters import parameter

__all__ = [
    "ArmControlError",
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
    "LifecycleState",
    "ManagerObserver",
    "NoParameters",
    "Pacer",
    "PacerStatistics",
    "ReturnType",
    "Strictness",
    "SwitchRequest",
    "SwitchResult",
    "Transition",
    "parameter",
    "parse_hardware_info",
]
