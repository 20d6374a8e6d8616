"""position_controllers/GripperActionController: a gripper that is told where to go."""

from typing import Any, ClassVar

from arm_control.gripper.gripper_controller import GripperController
from arm_control.gripper.parameters import GripperParameters
from arm_control.gripper.requests import GripperTarget
from arm_control.interface_configuration import InterfaceConfiguration


class PositionGripperController(GripperController[GripperParameters]):
    """Commands the position of the goal; its effort is reported, and has no effect."""

    parameters_type: ClassVar[type[Any]] = GripperParameters
    adapter = "arm_control.ros.gripper_adapter:GripperCommandAdapter"
    deprecated_type = "position_controllers/GripperActionController"

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the joint's position."""
        return self._interfaces_of_joint(("position",))

    def command(
        self, target: GripperTarget, position: float, velocity: float, period_s: float
    ) -> float:
        """Command the position."""
        self.commands.write(target.position)
        return target.max_effort
