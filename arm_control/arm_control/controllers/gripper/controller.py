"""The gripper controllers: one state machine for goals, and three kinds of commands."""

import logging
import struct
from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from math import isfinite, isnan, nan
from typing import Any, ClassVar, Generic, Protocol, TypeVar

import numpy as np

from arm_control.controllers.controller import (
    ControllerContext,
    InterfaceConfiguration,
    ReturnType,
)
from arm_control.controllers.goals import (
    GoalController,
    GoalOutcome,
    RequestQueue,
    refused_while_inactive,
)
from arm_control.controllers.gripper.goals import (
    CANCELED,
    PREEMPTED,
    RESET,
    RESTORED,
    GripperCancel,
    GripperRequest,
    GripperResult,
    GripperState,
    GripperTarget,
    deactivated,
    reached,
    stalled,
    unmeasured,
)
from arm_control.controllers.gripper.parameters import (
    EffortGripperParameters,
    GripperParameters,
    ParallelGripperParameters,
    PositionGripperParameters,
)
from arm_control.controllers.pid import Pid, PidGains
from arm_control.errors import ControllerError
from arm_control.run_inputs import run_input


class GripperSink(Protocol):
    """Receives the gripper controller's results on the loop thread; it must return quickly."""

    def open(self) -> None:
        """Prepare for goals; called at each activation."""
        ...

    def finish_goal(self, goal_id: object, result: GripperResult) -> None:
        """End a goal; called once for each accepted goal, in the cycle in which it ends."""
        ...


class _GripperStatus(Enum):
    """Progress of a goal."""

    MOVING = "moving"
    REACHED = "reached"
    STALLED = "stalled"
    UNMEASURED = "unmeasured"


@dataclass(slots=True)
class _GoalWatch:
    """Checks the progress of one goal in every cycle. Loop thread only.

    Attributes:
        tolerance: a joint closer than this has reached its goal, in rad or m.
        still_velocity: a joint no faster than this is at rest, in rad/s or m/s.
        stall_timeout_s: a joint at rest for longer has stalled; a joint whose state is not a number
            for longer counts as unmeasured.
        still_s: how long the joint has been at rest.
        lost_s: how long its state has not been a number.
    """

    tolerance: float
    still_velocity: float
    stall_timeout_s: float
    still_s: float = 0.0
    lost_s: float = 0.0

    def judge(self, error: float, velocity: float, period_s: float) -> _GripperStatus:
        """Return the progress of the goal after a period.

        `error` is the signed distance to the goal; it and the velocity are NaN if unknown. The
        period begins with the last call, or with the goal.
        """
        if not (isfinite(error) and isfinite(velocity)):
            self.still_s, self.lost_s = 0.0, self.lost_s + period_s
            return (
                _GripperStatus.UNMEASURED
                if self.lost_s > self.stall_timeout_s
                else _GripperStatus.MOVING
            )
        self.lost_s = 0.0
        if abs(error) < self.tolerance:
            return _GripperStatus.REACHED
        # Sums periods instead of comparing times, so that setting the clock back does no harm.
        self.still_s = self.still_s + period_s if abs(velocity) <= self.still_velocity else 0.0
        return (
            _GripperStatus.STALLED if self.still_s > self.stall_timeout_s else _GripperStatus.MOVING
        )


ParametersT = TypeVar("ParametersT", bound=GripperParameters)

STATES = ("position", "velocity")
"""The joint's states that are read, in this order."""


class GripperController(GoalController[ParametersT], Generic[ParametersT]):
    """Moves one joint to a goal position and holds it there.

    Goals may arrive on any thread. They take effect at the next update, or when `serve_requests` is
    called on the loop thread, which cancels and preempts goals even while the simulation is paused.

    Attributes:
        sink: receives the results; None drops them. Set it before activation.
        older_type: its type string if upstream has a newer one; else empty.
    """

    older_type: ClassVar[str] = ""
    transient = ("_requests", "_joint")

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        if self.older_type:
            # Upstream warns; here both types stay, and the tutorials' clients need this one.
            self.logger.info(
                "%s serves control_msgs/action/GripperCommand; upstream's newer type is "
                "parallel_gripper_action_controller/GripperActionController, which serves "
                "control_msgs/action/ParallelGripperCommand",
                self.older_type,
            )
        self.sink: GripperSink | None = None
        self._requests: RequestQueue[GripperRequest | GripperCancel] = RequestQueue()
        self._joint = ""
        self._target = GripperTarget(0.0, 0.0, 0.0)
        self._goal_id: object = None
        self._watch = _GoalWatch(0.0, 0.0, 0.0)
        self._seen_position = nan

    # Requests: any thread, once configured

    def check_goal(self, request: GripperRequest) -> str:
        """Return why a goal must be rejected; empty if it is acceptable."""
        is_open = self._requests.is_open
        refusal = _fault_of(request) if is_open else refused_while_inactive(self.halted_by)
        if refusal:
            self.logger.error("%s", refusal)
        return refusal

    @run_input
    def submit_goal(self, request: GripperRequest) -> GripperResult | None:
        """Start a goal that `check_goal` accepts; it replaces the previous one.

        Returns:
            None if the sink will receive the result; the result itself if the goal has already
            ended because the controller is not running.
        """
        taken = self._requests.put(request)
        if taken:
            return None
        return GripperResult(GoalOutcome.ABORTED, refused_while_inactive(self.halted_by))

    @run_input
    def cancel_goal(self, goal_id: object) -> None:
        """Cancel a goal and hold; has no effect if it has already ended."""
        self._requests.put(GripperCancel(goal_id))

    # Loop thread

    @property
    def max_velocity(self) -> float:
        """Default velocity limit, in rad/s or m/s; 0 for none."""
        return 0.0

    @abstractmethod
    def command(
        self, target: GripperTarget, position: float, velocity: float, period_s: float
    ) -> float:
        """Write the commands of one cycle.

        Position and velocity are those of the joint, in rad or m, and per second.

        Returns:
            The effort to report in the result, in N m or N.
        """

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read the joint's position and velocity."""
        return self._interfaces_of_joint(STATES)

    def on_configure(self, parameters: ParametersT) -> None:
        """Take the parameters.

        Raises:
            ControllerError: the joint is empty.
            ParameterError: one is out of its range.
        """
        if not parameters.joint:
            raise ControllerError("'joint' parameter was empty")
        parameters.check()
        self._parameters = parameters
        self._joint = parameters.joint

    def update_parameters(self, parameters: ParametersT) -> None:
        """Apply changed parameters; they take effect with the next goal.

        The joint and the interfaces change only when the controller is configured again.

        Raises:
            ParameterError: one is out of its range; the old ones stay.
        """
        parameters.check()
        self._parameters = parameters

    def on_activate(self) -> None:
        """Hold the joint at its position and start accepting goals."""
        self._seen_position = nan
        self._hold()
        if self.sink is not None:
            self.sink.open()
        self._requests.open()

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Run one cycle."""
        self._serve_requests()
        position, velocity = self._measure()
        if isnan(self._target.position):
            self._hold()
        effort = self.command(self._target, position, velocity, period_s)
        if self._goal_id is not None:
            self._judge(GripperState(position, velocity, effort), period_s)
        return ReturnType.OK

    @run_input
    def serve_requests(self) -> None:
        """Process the clients' requests; a motion starts at the next update."""
        self._serve_requests()

    def _serve_requests(self) -> None:
        if not self._requests:
            return
        for request in self._requests.take():
            match request:
                case GripperRequest():
                    self._end(PREEMPTED)
                    self._start(request)
                case GripperCancel(goal_id):
                    if goal_id == self._goal_id:
                        self._hold()
                        self._end(CANCELED)

    def save_state(self) -> Any:
        """Return the set-point and the goal; pending requests are served first."""
        self._serve_requests()
        return super().save_state()

    def load_state(self, state: Any) -> None:
        """Continue with a saved goal; a different one that is running is aborted."""
        self._serve_requests()
        if state["_goal_id"] != self._goal_id:
            self._end(RESTORED)
        super().load_state(state)

    def fingerprint(self) -> bytes:
        """Return the numbers of the set-point and of the goal's progress."""
        target, watch = self._target, self._watch
        return struct.pack(
            "<6d?",
            target.position,
            target.max_effort,
            target.max_velocity,
            watch.still_s,
            watch.lost_s,
            self._seen_position,
            self._goal_id is not None,
        )

    def on_reset(self) -> None:
        """Abort the goal and hold the joint where it is."""
        self._serve_requests()
        self._end(RESET)
        self._seen_position = nan
        self._hold()

    def on_deactivate(self) -> None:
        """Abort the goal."""
        state = GripperState(*self._measure(), self._target.max_effort)
        for request in self._requests.close():
            if isinstance(request, GripperRequest):
                self._end(PREEMPTED)
                self._goal_id = request.id
        self._end(deactivated(state, self.halted_by))

    def _start(self, request: GripperRequest) -> None:
        parameters = self.parameters
        self._goal_id = request.id
        self._target = GripperTarget(
            request.positions[0],
            request.efforts[0] if request.efforts else parameters.max_effort,
            request.velocities[0] if request.velocities else self.max_velocity,
        )
        self._watch = _GoalWatch(
            parameters.goal_tolerance, parameters.stall_velocity_threshold, parameters.stall_timeout
        )

    def _judge(self, state: GripperState, period_s: float) -> None:
        error = self._target.position - state.position
        match self._watch.judge(error, state.velocity, period_s):
            case _GripperStatus.REACHED:
                self._end(reached(state))
            case _GripperStatus.STALLED:
                is_success = self.parameters.allow_stalling
                self._end(stalled(state, self._target.position, is_success=is_success))
            case _GripperStatus.UNMEASURED:
                values = zip(STATES, (state.position, state.velocity), strict=True)
                names = [f"{self._joint}/{kind}" for kind, value in values if not isfinite(value)]
                self._hold()
                self._end(unmeasured(state, names))
            case _GripperStatus.MOVING:
                pass

    def _hold(self) -> None:
        """Hold the last known position; command nothing before a position is known."""
        self._measure()
        self._target = GripperTarget(
            self._seen_position, self.parameters.max_effort, self.max_velocity
        )

    def _end(self, result: GripperResult) -> None:
        """End the goal, if there is one."""
        if self._goal_id is None:
            return
        goal_id, self._goal_id = self._goal_id, None
        level = logging.WARNING if result.outcome is GoalOutcome.ABORTED else logging.INFO
        self.logger.log(level, "%s", result.message)
        if self.sink is not None:
            self.sink.finish_goal(goal_id, result)

    def _measure(self) -> tuple[float, float]:
        position, velocity = self.states.read()[: len(STATES)].tolist()
        if isfinite(position):
            self._seen_position = position
        return position, velocity

    def _interfaces_of_joint(self, kinds: Sequence[str]) -> InterfaceConfiguration:
        return InterfaceConfiguration.individual(f"{self._joint}/{kind}" for kind in kinds)


def _fault_of(request: GripperRequest) -> str:
    """Return why a request is invalid; empty if it is valid."""
    numbers: Mapping[str, Sequence[float]] = {
        "position": request.positions,
        "effort": request.efforts,
        "velocity": request.velocities,
    }
    for kind, values in numbers.items():
        if len(values) > 1 or (kind == "position" and not values):
            expected = "1" if kind == "position" else "at most 1"
            return (
                f"Received action goal with wrong number of {kind} values, "
                f"expects {expected}, got {len(values)}"
            )
        if not all(map(isfinite, values)):
            return f"Received action goal whose {kind} is not finite: {values[0]:g}"
    return ""


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
