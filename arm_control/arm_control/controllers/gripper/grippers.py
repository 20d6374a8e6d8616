"""The three gripper controllers of ros2_controllers: position, parallel and effort."""

from typing import Any, ClassVar

import numpy as np

from arm_control.controllers.controller import ControllerContext, InterfaceConfiguration
from arm_control.controllers.gripper.controller import STATES, GripperController
from arm_control.controllers.gripper.goals import GripperRequest, GripperTarget
from arm_control.controllers.gripper.parameters import (
    EffortGripperParameters,
    ParallelGripperParameters,
    PositionGripperParameters,
)
from arm_control.controllers.pid import Pid, PidGains
from arm_control.errors import ControllerError


class PositionGripperController(GripperController[PositionGripperParameters]):
    """Commands the goal position and, if the hardware supports it, the effort limit."""

    parameters_type: ClassVar[type[Any]] = PositionGripperParameters
    adapter = "arm_control.controllers.gripper.ros:GripperCommandAdapter"
    older_type = "position_controllers/GripperActionController"

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the joint's position and the interface of the effort limit."""
        position = self._interfaces_of_joint(("position",)).names
        limit = self.parameters.max_effort_interface
        return InterfaceConfiguration.individual((*position, *([limit] if limit else [])))

    def command(
        self, target: GripperTarget, position: float, velocity: float, period_s: float
    ) -> float:
        """Command position and effort limit; for an effort of 0 the parameter sets the limit."""
        if self.parameters.max_effort_interface:
            limit = target.max_effort or self.parameters.max_effort
            self.commands.write([target.position, limit])
        else:
            self.commands.write(target.position)
        return target.max_effort


class ParallelGripperController(GripperController[ParallelGripperParameters]):
    """Commands the goal position and, if the hardware supports them, the goal's limits."""

    parameters_type: ClassVar[type[Any]] = ParallelGripperParameters
    adapter = "arm_control.controllers.gripper.ros:ParallelGripperAdapter"
    transient = ("_limits",)

    @property
    def max_velocity(self) -> float:
        """Default velocity limit, in rad/s or m/s."""
        return self.parameters.max_velocity

    def on_configure(self, parameters: ParallelGripperParameters) -> None:
        """Take the parameters.

        Raises:
            ControllerError: the joint is empty, or a state interface is missing.
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
        """Claim the joint's position and the interfaces of the limits."""
        position = self._interfaces_of_joint(("position",)).names
        return InterfaceConfiguration.individual((*position, *(name for name, _ in self._limits)))

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read the state interfaces in the parameters, position and velocity first."""
        given = self.parameters.state_interfaces
        return self._interfaces_of_joint((*STATES, *(k for k in given if k not in STATES)))

    def command(
        self, target: GripperTarget, position: float, velocity: float, period_s: float
    ) -> float:
        """Command position and limits; return the effort limit."""
        limits = [getattr(target, kind) for _, kind in self._limits]
        self.commands.write([target.position, *limits])
        return target.max_effort


class EffortGripperController(GripperController[EffortGripperParameters]):
    """Drives the joint with a PID controller, within the goal's effort limit.

    As in ros2_control, a limit of 0 allows no effort at all. The parameter `max_effort` limits the
    effort that holds the joint without a goal: after activation and after a goal was cancelled.
    """

    parameters_type: ClassVar[type[Any]] = EffortGripperParameters
    adapter = "arm_control.controllers.gripper.ros:GripperCommandAdapter"
    older_type = "effort_controllers/GripperActionController"

    def fingerprint(self) -> bytes:
        """Return the numbers of the set-point, of the goal's progress and of the integral."""
        return super().fingerprint() + self._pid.save_state().tobytes()

    def on_reset(self) -> None:
        """Abort the goal and hold the joint where it is, with the integral reset."""
        super().on_reset()
        self._pid = Pid([self.parameters.pid_gains])

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self._pid = Pid([PidGains()])

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the joint's effort."""
        return self._interfaces_of_joint(("effort",))

    def update_parameters(self, parameters: EffortGripperParameters) -> None:
        """Apply changed parameters; gains take effect in the next cycle.

        Raises:
            ParameterError: one is out of its range; the old ones stay.
        """
        super().update_parameters(parameters)
        self._pid.set_gains([parameters.pid_gains])

    def on_activate(self) -> None:
        """Hold the joint at its position, with the integral reset."""
        self._pid = Pid([self.parameters.pid_gains])
        super().on_activate()

    def command(
        self, target: GripperTarget, position: float, velocity: float, period_s: float
    ) -> float:
        """Command the effort and return it."""
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
        """Abort the goal and command zero effort."""
        super().on_deactivate()
        self.commands.write(0.0)
