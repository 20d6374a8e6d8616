"""The executed plan, its speed, its goal, and how the goal ends.

Without a goal tolerance, ros2_controllers ends a goal by time alone. Here a joint that rests far
from its end, because something blocks it or nothing drives it, does not count as arrived. One that
is late but comes closer does.
"""

import logging
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.goals import RequestQueue
from arm_control.controllers.joint_trajectory.goals import (
    GOAL_REACHED,
    RESTORED,
    GoalOutcome,
    GoalRequest,
    GoalResult,
    Tolerances,
    not_checkable,
    stalled,
)
from arm_control.controllers.joint_trajectory.parameters import (
    Configuration,
    SpeedScalingParameters,
)
from arm_control.controllers.joint_trajectory.plans import (
    LARGEST,
    POSITION,
    RESOLUTION_S,
    MotionPlan,
)
from arm_control.controllers.joint_trajectory.state import (
    ControllerState,
    Feedback,
    Progress,
    TrajectorySink,
)
from arm_control.controllers.joint_trajectory.trajectory import Trajectory
from arm_control.loop.schedule import Schedule


class SpeedScaling:
    """The factor between trajectory time and the controller's time.

    A client requests it. If the hardware has a state interface for it, the hardware sets it; then
    the request goes to the hardware's command interface, if there is one.

    Attributes:
        factor: the current factor; 0 stops trajectories. Loop thread.
        requested: the factor that a client requested last.
    """

    def __init__(self, parameters: SpeedScalingParameters, logger: logging.Logger) -> None:
        """Start with the initial factor."""
        self.factor = self.requested = parameters.initial_scaling_factor
        self._parameters = parameters
        self._logger = logger

    @property
    def command_names(self) -> tuple[str, ...]:
        """The command interface for the requested factor, if there is one."""
        return tuple(filter(None, (self._parameters.command_interface,)))

    @property
    def state_names(self) -> tuple[str, ...]:
        """The state interface of the factor, if there is one."""
        return tuple(filter(None, (self._parameters.state_interface,)))

    def request(self, factor: float) -> bool:
        """Request a factor; any thread. Return whether it was accepted."""
        if not _is_factor(factor):
            self._logger.warning(
                "Scaling factor has to be greater or equal to 0.0 - Ignoring input! (%g)", factor
            )
            return False
        if self.state_names and not self.command_names:
            self._logger.warning(
                "the hardware sets the speed scaling factor, so the requested %g has no effect; "
                "see the parameter speed_scaling.command_interface",
                factor,
            )
        self.requested = factor
        return True

    def save_state(self) -> tuple[float, float]:
        """Return the factor and the requested one."""
        return self.factor, self.requested

    def load_state(self, state: tuple[float, float]) -> None:
        """Set the factor and the requested one."""
        self.factor, self.requested = state

    def refresh(self, measured: float | None) -> None:
        """Apply the requested factor, or the one that the hardware reports."""
        factor = self.requested if measured is None else measured
        # Hardware that is still starting reports no valid factor; the old one stays.
        if _is_factor(factor):
            self.factor = factor


def _is_factor(value: float) -> bool:
    return 0.0 <= value <= LARGEST


@dataclass(frozen=True, slots=True)
class GoalStart:
    """A request to start a goal."""

    goal: GoalRequest
    trajectory: Trajectory


@dataclass(frozen=True, slots=True)
class GoalCancel:
    """A request to cancel a goal."""

    goal_id: object


@dataclass(frozen=True, slots=True)
class TrajectoryReplacement:
    """A request to start a trajectory without a goal."""

    trajectory: Trajectory


@dataclass(frozen=True, slots=True)
class Stop:
    """Come to rest."""


Request = GoalStart | GoalCancel | TrajectoryReplacement
Motion = GoalStart | TrajectoryReplacement | Stop
"""What begins as soon as every position is known."""


class Inbox(RequestQueue[Request]):
    """The controller's request queue, in which a stream of trajectories does not pile up."""

    def _append(self, request: Request) -> None:
        # A trajectory replaces another one directly before it.
        last = self._requests[-1] if self._requests else None
        if isinstance(request, TrajectoryReplacement) and isinstance(last, TrajectoryReplacement):
            self._requests.pop()
        super()._append(request)


class ActiveGoal:
    """Holds at most one goal, and sends feedback and the result. Loop thread only.

    Attributes:
        goal: the goal, or None.
    """

    def __init__(
        self, sink: TrajectorySink | None, feedback_rate_hz: float, logger: logging.Logger
    ) -> None:
        self.goal: GoalRequest | None = None
        self._sink = sink
        self._feedback = Schedule(feedback_rate_hz)
        self._logger = logger

    def start(self, goal: GoalRequest) -> None:
        """Set the goal; there must be no other."""
        self.goal = goal
        self._feedback.restart()

    def save_state(self) -> tuple[Any, ...]:
        """Return the goal, and when its feedback is due."""
        return self.goal, self._feedback.save_state()

    def load_state(self, state: tuple[Any, ...]) -> None:
        """Continue with a saved goal; a different one that is running is aborted."""
        goal, feedback = state
        if self.goal is not None and (goal is None or goal.id != self.goal.id):
            self.end(RESTORED)
        self.goal = goal
        self._feedback.load_state(feedback)

    def give_feedback(self, state: ControllerState) -> None:
        """Publish the goal's feedback if it is due.

        Intervals are in the controller's time and counted from the goal's start, so the rate does
        not depend on the speed of the simulation.
        """
        if self.goal is None or self._sink is None:
            return
        if not self._feedback.is_due(state.time_s):
            return
        self._sink.publish_feedback(
            self.goal.id,
            Feedback(
                state.time_s,
                state.progress,
                state.reference.copy(),
                state.feedback.copy(),
                state.error.copy(),
            ),
        )

    def end(self, result: GoalResult, detail: str = "") -> None:
        """End the goal, if there is one.

        Args:
            result: the result.
            detail: an addition for the log.
        """
        if self.goal is None:
            return
        goal, self.goal = self.goal, None
        level = logging.WARNING if result.outcome is GoalOutcome.ABORTED else logging.INFO
        message = result.message or f"Goal {result.outcome.value}"
        self._logger.log(level, "%s", f"{message}: {detail}" if detail else message)
        if self._sink is not None:
            self._sink.finish_goal(goal.id, result)


class ExecutionStatus(Enum):
    """Progress of an execution."""

    MOVING = "moving"
    PATH_TOLERANCE_VIOLATED = "path tolerance violated"
    GOAL_REACHED = "goal reached"
    SETTLING = "settling"
    GOAL_TIME_EXCEEDED = "goal time exceeded"


@dataclass(slots=True)
class Execution:
    """A plan and its progress. Loop thread only.

    Attributes:
        plan: the plan.
        tolerances: the tolerances to check.
        serves_goal: whether a goal ends with it.
        is_stop: whether it only brings the joints to rest: in real time, without a timeout.
        lead_s: time from the plan's start to the start of its trajectory; negative if the
            trajectory should have started earlier.
        elapsed_s: the plan's time.
        age_s: the controller's time since the plan's start; ahead of `elapsed_s` if the speed is
            scaled down.
        is_first: whether this is its first cycle.
        far_at_end: distance of each joint from its end when some were too far, shape (n,).
        far_since_s: `late_s` at that time.
    """

    plan: MotionPlan
    tolerances: Tolerances
    serves_goal: bool = False
    is_stop: bool = False
    lead_s: float = 0.0
    elapsed_s: float = 0.0
    age_s: float = 0.0
    is_first: bool = True
    far_at_end: NDArray[np.float64] | None = None
    far_since_s: float = 0.0

    def advance(self, period_s: float, speed_scaling: float) -> None:
        """Advance by a period."""
        self.elapsed_s = self.elapsed_after(period_s, speed_scaling)
        self.age_s += period_s
        self.is_first = False

    def elapsed_after(self, period_s: float, speed_scaling: float) -> float:
        """Return the plan's time after another period."""
        return self.elapsed_s + (period_s if self.is_stop else period_s * speed_scaling)

    @property
    def progress(self) -> Progress:
        """Its progress, as times since the start of its trajectory."""
        return Progress(self.elapsed_s - self.lead_s, self.age_s - self.lead_s)

    @property
    def late_s(self) -> float:
        """Time since the end of the plan; negative before it."""
        return self.elapsed_s - self.plan.end_s

    def judge(self, error: NDArray[np.float64]) -> ExecutionStatus:
        """Compare errors with the tolerances.

        Args:
            error: errors of position and, if checked, velocity and acceleration; shape (k, n).
        """
        late_s = self.late_s
        has_ended = late_s >= -RESOLUTION_S
        # A plan may have ended before its first cycle; then the path is checked once.
        if (self.is_first or not has_ended) and not self.tolerances.path.hold(error):
            return ExecutionStatus.PATH_TOLERANCE_VIOLATED
        if not has_ended:
            return ExecutionStatus.MOVING
        if self.tolerances.goal.hold(error):
            return ExecutionStatus.GOAL_REACHED
        if 0.0 < self.tolerances.goal_time_s < late_s - RESOLUTION_S:
            return ExecutionStatus.GOAL_TIME_EXCEEDED
        return ExecutionStatus.SETTLING

    def settle(self) -> None:
        """Stay at the end: no goal waits, and no tolerance is checked any more."""
        self.serves_goal = False
        self.tolerances = self.tolerances.switched_off()
        self.is_stop = True


FAR = {"rad": 0.05, "m": 0.005}
"""A joint farther than this from its end may have stalled; closer, it is a controller's error."""
STALL_S = 0.5
"""How long such a joint has to come closer."""
CLOSER = 0.1
"""By which fraction of its distance it must have come closer by then."""


def result_at_end(
    status: ExecutionStatus,
    execution: Execution,
    error: NDArray[np.float64],
    unmeasured: Sequence[str],
    configuration: Configuration,
) -> GoalResult | None:
    """Return the result of a goal whose plan has ended; None while it has none yet.

    Args:
        status: GOAL_REACHED or SETTLING.
        execution: the goal's execution; it notes where far joints were.
        error: errors of the checked quantities, shape (k, n).
        unmeasured: names of the states that are not numbers.
        configuration: of the controller.
    """
    if unmeasured:
        too_late = execution.late_s > execution.tolerances.goal_time_s - RESOLUTION_S
        return not_checkable(unmeasured) if too_late else None
    if status is not ExecutionStatus.GOAL_REACHED:
        return None
    distance = np.abs(error[POSITION])
    far = _far(distance, execution, configuration)
    if not far.any():
        return GOAL_REACHED
    if execution.far_at_end is None:
        execution.far_at_end, execution.far_since_s = distance, execution.late_s
        return None
    if execution.late_s - execution.far_since_s < STALL_S - RESOLUTION_S:
        return None
    resting = far & (distance > (1.0 - CLOSER) * execution.far_at_end)
    if not resting.any():
        return GOAL_REACHED
    joint = int(np.flatnonzero(resting)[0])
    model = configuration.model
    return stalled(model.joints[joint], float(distance[joint]), model.units[joint])


def _far(
    distance: NDArray[np.float64], execution: Execution, configuration: Configuration
) -> NDArray[np.bool_]:
    """Return which commanded joints without a goal tolerance are far from their end."""
    far = distance > np.array([FAR[unit] for unit in configuration.model.units])
    is_commanded = np.zeros(len(far), dtype=bool)
    is_commanded[configuration.interfaces.commanded] = True
    return far & is_commanded & np.isinf(execution.tolerances.goal.values[POSITION])
