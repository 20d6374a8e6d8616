"""position_controllers/GripperActionController: a gripper that is told where to go."""

from typing import Any, ClassVar

from arm_control.gripper.gripper_controller import GripperController
from arm_control.gripper.parameters import PositionGripperParameters
from arm_control.gripper.requests import GripperTarget
from arm_control.interface_configuration import InterfaceConfiguration


class PositionGripperController(GripperController[PositionGripperParameters]):
    """Commands the position of the goal and, where hardware takes it, the most effort."""

    parameters_type: ClassVar[type[Any]] = PositionGripperParameters
    adapter = "arm_control.ros.gripper_adapter:GripperCommandAdapter"
    deprecated_type = "position_controllers/GripperActionController"

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the joint's position, and the interface of the limit."""
        position = self._interfaces_of_joint(("position",)).names
        limit = self.parameters.max_effort_interface
        return InterfaceConfiguration.individual((*position, *([limit] if limit else [])))

    def command(
        self, target: GripperTarget, position: float, velocity: float, period_s: float
    ) -> float:
        """Command position and limit; an effort of 0 leaves the limit to the parameter."""
        if self.parameters.max_effort_interface:
            limit = target.max_effort or self.parameters.max_effort
            self.commands.write([target.position, limit])
        else:
            self.commands.write(target.position)
        return target.max_effort
