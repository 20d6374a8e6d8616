"""parallel_gripper_action_controller/GripperActionController: hardware that limits itself."""

from typing import Any, ClassVar

from arm_control.errors import ControllerError
from arm_control.gripper.gripper_controller import STATES, GripperController
from arm_control.gripper.parameters import ParallelGripperParameters
from arm_control.gripper.requests import GripperTarget
from arm_control.interface_configuration import InterfaceConfiguration


class ParallelGripperController(GripperController[ParallelGripperParameters]):
    """Commands the position of the goal and, where hardware takes them, its limits."""

    parameters_type: ClassVar[type[Any]] = ParallelGripperParameters
    adapter = "arm_control.ros.gripper_adapter:ParallelGripperAdapter"

    @property
    def max_velocity(self) -> float:
        """Fastest motion where no goal says more, in rad/s or m/s."""
        return self.parameters.max_velocity

    def on_configure(self, parameters: ParallelGripperParameters) -> None:
        """Take the parameters.

        Raises:
            ControllerError: there is no joint among them, or a state is missing.
            ParameterError: one is out of its range.
        """
        super().on_configure(parameters)
        for kind in STATES:
            if kind not in parameters.state_interfaces:
                raise ControllerError(
                    f"parameter 'state_interfaces' is [{', '.join(parameters.state_interfaces)}]; "
                    f"it lacks '{kind}'"
                )
        self._limits = tuple(
            (name, kind)
            for name, kind in (
                (parameters.max_effort_interface, "max_effort"),
                (parameters.max_velocity_interface, "max_velocity"),
            )
            if name
        )

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the joint's position, and the interfaces of the limits."""
        position = self._interfaces_of_joint(("position",)).names
        return InterfaceConfiguration.individual((*position, *(name for name, _ in self._limits)))

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read the states of the parameters, position and velocity first."""
        given = self.parameters.state_interfaces
        return self._interfaces_of_joint((*STATES, *(k for k in given if k not in STATES)))

    def command(
        self, target: GripperTarget, position: float, velocity: float, period_s: float
    ) -> float:
        """Command position and limits; return the limit of effort."""
        limits = [getattr(target, kind) for _, kind in self._limits]
        self.commands.write([target.position, *limits])
        return target.max_effort
