"""Finds controllers and hardware by their ros2_control type string.

Built-in ones stand in the tables below. Anybody's package adds its own through the entry-point
groups 'arm_control.controllers' and 'arm_control.hardware': the entry point's name is the type
string, its value 'module:Class'. Installed packages are searched only for types that are not
built in, because that takes tens of milliseconds.
"""

import importlib
import logging
from typing import TYPE_CHECKING, Any

from arm_control.chainable_controller import ChainableController
from arm_control.controller import Controller
from arm_control.errors import ArmControlError, RegistryError
from arm_control.hardware import Hardware
from arm_control.hardware_info import HardwareInfo

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

logger = logging.getLogger(__name__)

CONTROLLER_GROUP = "arm_control.controllers"
HARDWARE_GROUP = "arm_control.hardware"

_FORWARD = "arm_control.forward_command_controller"
_GRIPPER = "arm_control.gripper"
_FORCE_TORQUE = "arm_control.force_torque_sensor_broadcaster"
_CONTROLLERS = {
    "diff_drive_controller/DiffDriveController": "arm_control.diff_drive:DiffDriveController",
    "effort_controllers/GripperActionController": f"{_GRIPPER}:EffortGripperController",
    "effort_controllers/JointGroupEffortController": f"{_FORWARD}:JointGroupEffortController",
    "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster": (
        f"{_FORCE_TORQUE}:ForceTorqueSensorBroadcaster"
    ),
    "forward_command_controller/ForwardCommandController": f"{_FORWARD}:ForwardCommandController",
    "forward_command_controller/MultiInterfaceForwardCommandController": (
        f"{_FORWARD}:MultiInterfaceForwardCommandController"
    ),
    "imu_sensor_broadcaster/IMUSensorBroadcaster": (
        "arm_control.imu_sensor_broadcaster:ImuSensorBroadcaster"
    ),
    "joint_state_broadcaster/JointStateBroadcaster": (
        "arm_control.joint_state_broadcaster:JointStateBroadcaster"
    ),
    "joint_trajectory_controller/JointTrajectoryController": (
        "arm_control.joint_trajectory:JointTrajectoryController"
    ),
    "parallel_gripper_action_controller/GripperActionController": (
        f"{_GRIPPER}:ParallelGripperController"
    ),
    "pid_controller/PidController": "arm_control.pid_controller:PidController",
    "position_controllers/GripperActionController": f"{_GRIPPER}:PositionGripperController",
    "position_controllers/JointGroupPositionController": f"{_FORWARD}:JointGroupPositionController",
    "position_controllers/JointPositionController": f"{_FORWARD}:JointPositionController",
    "velocity_controllers/JointGroupVelocityController": f"{_FORWARD}:JointGroupVelocityController",
}
_HARDWARE = {"mock_components/GenericSystem": "arm_control.mock_components:GenericSystem"}


def controller_types() -> tuple[str, ...]:
    """Return every controller type there is, sorted."""
    return tuple(sorted({*_CONTROLLERS, *(point.name for point in _installed(CONTROLLER_GROUP))}))


def controller_class(type_name: str) -> type[Controller[Any]]:
    """Return the class of a controller type.

    Raises:
        RegistryError: nothing offers the type, or what does cannot be imported or is no controller.
    """
    found = _find(type_name, _CONTROLLERS, CONTROLLER_GROUP, "controller type")
    if not (isinstance(found, type) and issubclass(found, Controller)):
        raise RegistryError(
            f"controller type '{type_name}' is {found!r}, "
            "which does not derive from arm_control.Controller"
        )
    return found


def is_chainable(type_name: str) -> bool:
    """Return whether controllers of a type may be commanded by others; imports the type.

    A type that cannot be imported is none; `controller_class` says why.
    """
    try:
        return issubclass(controller_class(type_name), ChainableController)
    except RegistryError:
        return False


def create_hardware(info: HardwareInfo) -> Hardware:
    """Make the driver that a hardware component's plugin names.

    Raises:
        RegistryError: nothing offers the plugin, or what does cannot be imported or made.
        ArmControlError: the driver refuses what the description says.
    """
    make = _find(info.plugin, _HARDWARE, HARDWARE_GROUP, "hardware plugin")
    try:
        return make(info)
    except ArmControlError:
        raise
    except Exception as error:
        # A driver is outside code, so anything may come out of it.
        logger.exception("hardware component '%s' cannot be made", info.name)
        raise RegistryError(
            f"hardware component '{info.name}' cannot be made by '{info.plugin}': "
            f"{type(error).__name__}: {error}"
        ) from error


def load_object(path: str) -> Any:
    """Import what 'module:Name' names.

    Raises:
        RegistryError: there is no such module or name, or importing it fails.
    """
    module_name, _, name = path.partition(":")
    try:
        return getattr(importlib.import_module(module_name), name)
    except Exception as error:
        # Importing runs anybody's code, so anything may come out of it.
        raise RegistryError(f"cannot import '{path}': {type(error).__name__}: {error}") from error


def _find(type_name: str, built_in: dict[str, str], group: str, what: str) -> Any:
    if type_name in built_in:
        return load_object(built_in[type_name])
    points = _installed(group)
    for point in points:
        if point.name == type_name:
            return load_object(point.value)
    known = sorted({*built_in, *(point.name for point in points)})
    raise RegistryError(f"no {what} '{type_name}'; there is {', '.join(known)}")


def _installed(group: str) -> "tuple[EntryPoint, ...]":
    # Imported here: it costs a start that needs only built-in types 20 ms.
    from importlib.metadata import entry_points

    return tuple(entry_points(group=group))
