"""What all gripper controllers have in common: goals that are reached, stall, or are called off."""

import logging
from abc import abstractmethod
from collections.abc import Mapping, Sequence
from math import isfinite, isnan, nan
from typing import ClassVar, Generic, TypeVar

from arm_control.controller import Controller, ControllerContext, ReturnType
from arm_control.errors import ControllerError
from arm_control.goal_outcome import Outcome
from arm_control.gripper.goal_watch import GoalWatch, Verdict
from arm_control.gripper.gripper_sink import GripperSink
from arm_control.gripper.parameters import GripperParameters
from arm_control.gripper.requests import GoalCancel, GripperRequest, GripperTarget
from arm_control.gripper.results import (
    CANCELED,
    NOT_RUNNING,
    PREEMPTED,
    GripperResult,
    GripperState,
    deactivated,
    reached,
    stalled,
)
from arm_control.interface_configuration import InterfaceConfiguration
from arm_control.request_queue import RequestQueue

ParametersT = TypeVar("ParametersT", bound=GripperParameters)

STATES = ("position", "velocity")
"""What is read of the joint, in this order."""


class GripperController(Controller[ParametersT], Generic[ParametersT]):
    """Moves one joint to the position of a goal, and holds it there.

    Goals come in on any thread. They take effect at the next update, or as soon as somebody calls
    `serve_requests` on the loop thread: then a goal is cancelled or preempted even while the
    simulation stands still.

    Attributes:
        sink: where the news go; None drops them. Set it before activation.
        deprecated_type: its type string, where there is a type to use instead; else empty.
    """

    deprecated_type: ClassVar[str] = ""

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        if self.deprecated_type:
            self.logger.warning(
                "[Deprecated] %s: use parallel_gripper_action_controller/GripperActionController, "
                "whose action is control_msgs/action/ParallelGripperCommand",
                self.deprecated_type,
            )
        self.sink: GripperSink | None = None
        self._requests: RequestQueue[GripperRequest | GoalCancel] = RequestQueue()
        self._joint = ""
        self._target = GripperTarget(0.0, 0.0, 0.0)
        self._goal_id: object = None
        self._watch = GoalWatch(0.0, 0.0, 0.0)
        self._seen_position = nan

    # Requests: any thread, once configured

    def check_goal(self, request: GripperRequest) -> str:
        """Return why a goal is to be rejected, in a sentence; empty where it is not."""
        refusal = _fault_of(request) if self._requests.is_open else NOT_RUNNING
        if refusal:
            self.logger.error("%s", refusal)
        return refusal

    def submit_goal(self, request: GripperRequest) -> GripperResult | None:
        """Start a goal that `check_goal` lets pass; it takes the place of the one before.

        Returns:
            None: the sink will hear of the end. A result where the goal has ended already, because
            the controller is not running: the sink will not hear of it.
        """
        taken = self._requests.put(request)
        return None if taken else GripperResult(Outcome.ABORTED, NOT_RUNNING)

    def cancel_goal(self, goal_id: object) -> None:
        """End a goal, and hold; nothing happens where it has ended already."""
        self._requests.put(GoalCancel(goal_id))

    # Loop thread

    @property
    def max_velocity(self) -> float:
        """Fastest motion where no goal says more, in rad/s or m/s; 0 where nothing limits it."""
        return 0.0

    @abstractmethod
    def command(
        self, target: GripperTarget, position: float, velocity: float, period_s: float
    ) -> float:
        """Write the commands of one cycle.

        Args:
            target: what the joint shall do.
            position: of the joint, in rad or m.
            velocity: of the joint, in rad/s or m/s.
            period_s: since the last cycle.

        Returns:
            The effort that a result tells, in N m or N.
        """

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read the joint's position and velocity."""
        return self._interfaces_of_joint(STATES)

    def on_configure(self, parameters: ParametersT) -> None:
        """Take the parameters.

        Raises:
            ControllerError: there is no joint among them.
            ParameterError: one is out of its range.
        """
        if not parameters.joint:
            raise ControllerError("'joint' parameter was empty")
        parameters.check()
        self._parameters = parameters
        self._joint = parameters.joint

    def update_parameters(self, parameters: ParametersT) -> None:
        """Take parameters that changed; the next goal is judged by them.

        The joint and the interfaces stay as they are until the controller is configured anew.

        Raises:
            ParameterError: one is out of its range; the old ones stay.
        """
        parameters.check()
        self._parameters = parameters

    def on_activate(self) -> None:
        """Hold where the joint is, and begin to take goals."""
        self._seen_position = nan
        self._hold()
        if self.sink is not None:
            self.sink.open()
        self._requests.open()

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Run one cycle."""
        self.serve_requests()
        position, velocity = self._measure()
        if isnan(self._target.position):
            self._hold()
        effort = self.command(self._target, position, velocity, period_s)
        if self._goal_id is not None:
            self._judge(GripperState(position, velocity, effort), period_s)
        return ReturnType.OK

    def serve_requests(self) -> None:
        """Take over what clients have asked for; a motion begins at the next update."""
        if not self._requests:
            return
        for request in self._requests.take():
            match request:
                case GripperRequest():
                    self._end(PREEMPTED)
                    self._start(request)
                case GoalCancel(goal_id):
                    if goal_id == self._goal_id:
                        self._hold()
                        self._end(CANCELED)

    def on_deactivate(self) -> None:
        """Abort the goal."""
        state = GripperState(*self._measure(), self._target.max_effort)
        for request in self._requests.close():
            if isinstance(request, GripperRequest):
                self._end(PREEMPTED)
                self._goal_id = request.id
        self._end(deactivated(state))

    def _start(self, request: GripperRequest) -> None:
        parameters = self.parameters
        self._goal_id = request.id
        self._target = GripperTarget(
            request.positions[0],
            request.efforts[0] if request.efforts else parameters.max_effort,
            request.velocities[0] if request.velocities else self.max_velocity,
        )
        self._watch = GoalWatch(
            parameters.goal_tolerance, parameters.stall_velocity_threshold, parameters.stall_timeout
        )

    def _judge(self, state: GripperState, period_s: float) -> None:
        error = self._target.position - state.position
        match self._watch.judge(error, state.velocity, period_s):
            case Verdict.REACHED:
                self._end(reached(state))
            case Verdict.STALLED:
                is_success = self.parameters.allow_stalling
                self._end(stalled(state, self._target.position, is_success=is_success))
            case Verdict.UNDER_WAY:
                pass

    def _hold(self) -> None:
        """Stay where the joint was last seen: nowhere before its position is known at all."""
        self._measure()
        self._target = GripperTarget(
            self._seen_position, self.parameters.max_effort, self.max_velocity
        )

    def _end(self, result: GripperResult) -> None:
        """End the goal, if there is one."""
        if self._goal_id is None:
            return
        goal_id, self._goal_id = self._goal_id, None
        level = logging.WARNING if result.outcome is Outcome.ABORTED else logging.INFO
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
    """Return why a request cannot be followed; empty where it can."""
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
