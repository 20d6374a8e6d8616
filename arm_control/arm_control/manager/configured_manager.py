"""A controller manager as its settings ask for it."""

from collections.abc import Sequence

from arm_control.hardware.driver import Hardware
from arm_control.hardware.joint_limits import read_joint_limits
from arm_control.manager.controller_manager import NO_LIMITS, ControllerManager
from arm_control.manager.settings import ManagerSettings
from arm_description.urdf.description import Description


def configured_manager(
    hardware: Sequence[Hardware],
    settings: ManagerSettings,
    robot_description: Description,
    name: str,
) -> ControllerManager:
    """Return a manager whose components are still unconfigured; see `bring_up`.

    Args:
        hardware: the components' drivers.
        settings: the manager's settings.
        robot_description: the hardware's URDF, which has the command limits.
        name: fully qualified name of its node, for command lines in messages.

    Raises:
        ArmControlError: names are used twice, or requested limits cannot be read.
    """
    limited = settings.enforce_command_limits
    return ControllerManager(
        hardware,
        settings.update_rate,
        settings.policy,
        read_joint_limits(robot_description) if limited else NO_LIMITS,
        name,
    )


def bring_up(manager: ControllerManager, settings: ManagerSettings) -> None:
    """Bring the components to their initial states.

    Raises:
        ArmControlError: one of them fails, and the settings make that an error.
    """
    initial = settings.hardware_components_initial_state
    manager.bring_up(initial.unconfigured, initial.inactive)
