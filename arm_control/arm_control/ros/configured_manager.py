"""Makes and starts a controller manager as its node's parameters say."""

from collections.abc import Sequence

from arm_control.controller_manager import NO_LIMITS, ControllerManager
from arm_control.hardware import Hardware
from arm_control.joint_limits import read_joint_limits
from arm_control.ros.controller_manager_node import ControllerManagerNode
from arm_control.ros.manager_settings import ManagerSettings


def configured_manager(
    hardware: Sequence[Hardware], node: ControllerManagerNode, robot_description: str
) -> ControllerManager:
    """Return a manager whose components are still unconfigured; see `bring_up`.

    Args:
        hardware: the components' drivers.
        node: has its settings and its name.
        robot_description: the URDF that the hardware was made from; has the limits of commands.

    Raises:
        ArmControlError: names are used twice, or limits that are asked for cannot be read.
    """
    settings = node.settings
    limited = settings.enforce_command_limits
    return ControllerManager(
        hardware,
        settings.update_rate,
        settings.policy,
        read_joint_limits(robot_description) if limited else NO_LIMITS,
        node.get_fully_qualified_name(),
    )


def bring_up(manager: ControllerManager, settings: ManagerSettings) -> None:
    """Take the components to their initial states.

    Raises:
        ArmControlError: one of them does not get there, and that is to be an error.
    """
    initial = settings.hardware_components_initial_state
    manager.bring_up(initial.unconfigured, initial.inactive)
