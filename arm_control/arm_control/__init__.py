"""ros2_control in Python: hardware interface, controller manager, controllers and spawner.

This package exports what you need to write your own controller or hardware component.
`arm_control.testing` has fakes to test them with.
"""

from typing import TYPE_CHECKING

from arm_node.public_names import on_first_use

if TYPE_CHECKING:
    from arm_control.controllers.controller import ChainableController as ChainableController
    from arm_control.controllers.controller import Controller as Controller
    from arm_control.controllers.controller import ControllerContext as ControllerContext
    from arm_control.controllers.controller import InterfaceConfiguration as InterfaceConfiguration
    from arm_control.controllers.controller import NoParameters as NoParameters
    from arm_control.controllers.controller import ReturnType as ReturnType
    from arm_control.errors import ArmControlError as ArmControlError
    from arm_control.errors import ControllerError as ControllerError
    from arm_control.errors import ControllerManagerError as ControllerManagerError
    from arm_control.hardware.driver import Hardware as Hardware
    from arm_control.hardware.driver import HardwareReturn as HardwareReturn
    from arm_control.hardware.driver import SystemInterface as SystemInterface
    from arm_control.hardware.info import HardwareInfo as HardwareInfo
    from arm_control.hardware.info import InterfaceInfo as InterfaceInfo
    from arm_control.hardware.info import JointInfo as JointInfo
    from arm_control.hardware.info import parse_hardware_info as parse_hardware_info
    from arm_control.hardware.joint_limits import JointLimits as JointLimits
    from arm_control.hardware.joint_limits import SoftLimits as SoftLimits
    from arm_control.hardware.joint_limits import read_joint_limits as read_joint_limits
    from arm_control.lifecycle import LifecycleState as LifecycleState
    from arm_control.lifecycle import Transition as Transition
    from arm_control.loop.control_loop import ControlLoop as ControlLoop
    from arm_control.loop.pacer import Pacer as Pacer
    from arm_control.loop.pacer import PacerStatistics as PacerStatistics
    from arm_control.manager.controller_manager import ControllerManager as ControllerManager
    from arm_control.manager.controller_manager import ManagerObserver as ManagerObserver
    from arm_control.manager.settings import ManagerPolicy as ManagerPolicy
    from arm_control.manager.switch_planner import Strictness as Strictness
    from arm_control.manager.switch_planner import SwitchRequest as SwitchRequest
    from arm_control.manager.switch_planner import SwitchResult as SwitchResult
    from arm_control.parameters import parameter as parameter
    from arm_control.run_inputs import run_input as run_input

# A spawner runs for half a second and needs neither numpy nor the robot description, and importing
# those takes as long again.
__getattr__, __dir__ = on_first_use(__name__)
