"""effort_controllers/GripperActionController: a gripper that is told how hard to push."""

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from arm_control.controller import ControllerContext
from arm_control.gripper.gripper_controller import GripperController
from arm_control.gripper.parameters import EffortGripperParameters
from arm_control.gripper.requests import GripperRequest, GripperTarget
from arm_control.interface_configuration import InterfaceConfiguration
from arm_control.joint_trajectory.pid import Pid, PidGains
from arm_control.parameters import ParameterSpec


class EffortGripperController(GripperController[EffortGripperParameters]):
    """Drives the joint with a PID controller, no harder than the goal allows.

    As in ros2_control, 0 allows no effort at all. The parameter `max_effort` bounds what holds the
    joint where there is no goal: after an activation, and after a goal was cancelled.
    """

    parameters_type: ClassVar[type[Any]] = EffortGripperParameters
    adapter = "arm_control.ros.gripper_adapter:GripperCommandAdapter"
    deprecated_type = "effort_controllers/GripperActionController"

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self._pid = Pid([PidGains()])

    @classmethod
    def parameter_specs(cls, given: Mapping[str, Any]) -> tuple[ParameterSpec, ...]:
        """Return the parameters that there are for the joint among the given parameters."""
        return EffortGripperParameters.specs(given)

    @classmethod
    def build_parameters(cls, values: Mapping[str, Any]) -> EffortGripperParameters:
        """Return parameters from values by full name.

        Raises:
            ParameterError: a name is unknown, or a value cannot be used.
        """
        return EffortGripperParameters.build(values)

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the joint's effort."""
        return self._interfaces_of_joint(("effort",))

    def update_parameters(self, parameters: EffortGripperParameters) -> None:
        """Take parameters that changed; gains count from the next cycle on.

        Raises:
            ParameterError: one is out of its range; the old ones stay.
        """
        super().update_parameters(parameters)
        self._pid.set_gains([parameters.pid_gains])

    def on_activate(self) -> None:
        """Hold where the joint is, with nothing integrated yet."""
        self._pid = Pid([self.parameters.pid_gains])
        super().on_activate()

    def command(
        self, target: GripperTarget, position: float, velocity: float, period_s: float
    ) -> float:
        """Command the effort, and return it."""
        error, rate = np.array([target.position - position]), np.array([-velocity])
        limit = abs(target.max_effort)
        effort = np.clip(self._pid.update(error, rate, period_s), -limit, limit)
        self.commands.write(effort)
        return float(effort[0])

    def _start(self, request: GripperRequest) -> None:
        super()._start(request)
        if not self._target.max_effort:
            self.logger.warning(
                "The goal allows no effort (its max_effort is 0): the gripper will not be driven"
            )

    def on_deactivate(self) -> None:
        """Abort the goal, and let go of the joint."""
        super().on_deactivate()
        self.commands.write(0.0)
