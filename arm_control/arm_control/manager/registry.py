"""Finds controllers and hardware by their ros2_control type string.

The tables below list the built-in types. Other packages add types through the entry-point groups
'arm_control.controllers' and 'arm_control.hardware': the entry point's name is the type string, its
value is 'module:Class'. Installed packages are searched only for types that are not built in,
because the search takes tens of milliseconds.
"""

import importlib
import logging
from collections.abc import Callable, Collection
from typing import TYPE_CHECKING, Any

from arm_control.controllers.controller import ChainableController, Controller
from arm_control.errors import ArmControlError, RegistryError
from arm_control.hardware.driver import Hardware
from arm_control.hardware.info import HardwareInfo
from arm_control.manager.type_names import unknown_type

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

logger = logging.getLogger("controller_manager")

CONTROLLER_GROUP = "arm_control.controllers"
HARDWARE_GROUP = "arm_control.hardware"

_BUILT_IN = "arm_control.controllers"
_FORWARD = f"{_BUILT_IN}.forward_command.controller"
_GRIPPER = f"{_BUILT_IN}.gripper.controller"
_SENSORS = f"{_BUILT_IN}.sensor_broadcasters.controller"
_CONTROLLERS = {
    "diff_drive_controller/DiffDriveController": (
        f"{_BUILT_IN}.diff_drive.controller:DiffDriveController"
    ),
    "effort_controllers/GripperActionController": f"{_GRIPPER}:EffortGripperController",
    "effort_controllers/JointGroupEffortController": f"{_FORWARD}:JointGroupEffortController",
    "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster": (
        f"{_SENSORS}:ForceTorqueSensorBroadcaster"
    ),
    "forward_command_controller/ForwardCommandController": f"{_FORWARD}:ForwardCommandController",
    "forward_command_controller/MultiInterfaceForwardCommandController": (
        f"{_FORWARD}:MultiInterfaceForwardCommandController"
    ),
    "gpio_controllers/GpioCommandController": (
        f"{_BUILT_IN}.gpio_command.controller:GpioCommandController"
    ),
    "imu_sensor_broadcaster/IMUSensorBroadcaster": f"{_SENSORS}:ImuSensorBroadcaster",
    "joint_state_broadcaster/JointStateBroadcaster": (
        f"{_BUILT_IN}.joint_state_broadcaster.controller:JointStateBroadcaster"
    ),
    "joint_trajectory_controller/JointTrajectoryController": (
        f"{_BUILT_IN}.joint_trajectory.controller:JointTrajectoryController"
    ),
    "mecanum_drive_controller/MecanumDriveController": (
        f"{_BUILT_IN}.mecanum_drive.controller:MecanumDriveController"
    ),
    "parallel_gripper_action_controller/GripperActionController": (
        f"{_GRIPPER}:ParallelGripperController"
    ),
    "pid_controller/PidController": f"{_BUILT_IN}.pid_controller.controller:PidController",
    "position_controllers/GripperActionController": f"{_GRIPPER}:PositionGripperController",
    "position_controllers/JointGroupPositionController": f"{_FORWARD}:JointGroupPositionController",
    "position_controllers/JointPositionController": f"{_FORWARD}:JointPositionController",
    "velocity_controllers/JointGroupVelocityController": f"{_FORWARD}:JointGroupVelocityController",
}
_HARDWARE = {"mock_components/GenericSystem": "arm_control.hardware.mock_components:GenericSystem"}


def controller_types() -> tuple[str, ...]:
    """Return all controller types, sorted."""
    return tuple(sorted({*_CONTROLLERS, *(point.name for point in _installed(CONTROLLER_GROUP))}))


def controller_class(type_name: str) -> type[Controller[Any]]:
    """Return the class of a controller type.

    Raises:
        RegistryError: the type is unknown, cannot be imported, or is not a controller.
    """
    found = _find(type_name, _CONTROLLERS, CONTROLLER_GROUP, unknown_type)
    if not (isinstance(found, type) and issubclass(found, Controller)):
        raise RegistryError(
            f"controller type '{type_name}' is {found!r}, "
            "which does not derive from arm_control.Controller"
        )
    return found


def is_chainable(type_name: str) -> bool:
    """Return whether controllers of a type can be commanded by others; imports the type.

    A type that cannot be imported counts as not chainable; `controller_class` reports why.
    """
    try:
        return issubclass(controller_class(type_name), ChainableController)
    except RegistryError:
        return False


def create_hardware(info: HardwareInfo) -> Hardware:
    """Create the driver that a hardware component's plugin names.

    Raises:
        RegistryError: the plugin is unknown, or it cannot be imported or created.
        ArmControlError: the driver refuses the description.
    """
    make = _find(info.plugin, _HARDWARE, HARDWARE_GROUP, _unknown_plugin)
    try:
        return make(info)
    except ArmControlError:
        raise
    except Exception as error:
        # A driver is user code and may raise anything.
        logger.exception("hardware component '%s' cannot be created", info.name)
        raise RegistryError(
            f"hardware component '{info.name}' cannot be created by '{info.plugin}': "
            f"{type(error).__name__}: {error}"
        ) from error


def load_object(path: str) -> Any:
    """Import the object named by 'module:Name'.

    Raises:
        RegistryError: the module or name does not exist, or the import fails.
    """
    module_name, _, name = path.partition(":")
    try:
        return getattr(importlib.import_module(module_name), name)
    except Exception as error:
        # An import runs user code, which may raise anything.
        raise RegistryError(f"cannot import '{path}': {type(error).__name__}: {error}") from error


def _unknown_plugin(plugin: str, known: Collection[str]) -> str:
    return f"no hardware plugin '{plugin}'; known: {', '.join(sorted(known))}"


def _find(
    type_name: str,
    built_in: dict[str, str],
    group: str,
    unknown: Callable[[str, Collection[str]], str],
) -> Any:
    if type_name in built_in:
        return load_object(built_in[type_name])
    points = _installed(group)
    for point in points:
        if point.name == type_name:
            return load_object(point.value)
    raise RegistryError(unknown(type_name, {*built_in, *(point.name for point in points)}))


def _installed(group: str) -> "tuple[EntryPoint, ...]":
    # Imported here, because it takes 20 ms that a start with built-in types can save.
    from importlib.metadata import entry_points

    return tuple(entry_points(group=group))
