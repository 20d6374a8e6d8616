"""What the controller reports: its state in every cycle, a goal's feedback and its result."""

import logging
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np

from arm_control.controllers.joint_trajectory.configuration import InterfaceLayout
from arm_control.controllers.joint_trajectory.goals import (
    RESTORED,
    GoalOutcome,
    GoalRequest,
    GoalResult,
)
from arm_control.controllers.joint_trajectory.profiles import EFFORT, QUANTITIES, ROWS, Array
from arm_control.loop.schedule import Schedule

MOTION_ROWS = 3
"""Position, velocity and acceleration are always in the reference."""


@dataclass(frozen=True, slots=True)
class StateLayout:
    """The quantities of a `ControllerState`, each for every joint.

    Attributes:
        joints: names of the joints.
        reference: quantities of the set-point: 'position', 'velocity', ...
        feedback: measured quantities.
        error: quantities of reference minus feedback; 0 for those that are not checked.
        output: commanded quantities.
    """

    joints: tuple[str, ...]
    reference: tuple[str, ...]
    feedback: tuple[str, ...]
    error: tuple[str, ...]
    output: tuple[str, ...]

    @classmethod
    def of(cls, interfaces: InterfaceLayout) -> "StateLayout":
        """Return the layout for these interfaces."""
        measured = tuple(QUANTITIES[row] for row in interfaces.state_rows)
        reference_rows = ROWS if EFFORT in interfaces.command_rows else MOTION_ROWS
        return cls(
            joints=interfaces.joints,
            reference=QUANTITIES[:reference_rows],
            feedback=measured,
            error=measured,
            output=tuple(QUANTITIES[row] for row in interfaces.command_rows),
        )


class Progress(NamedTuple):
    """Progress of a trajectory as values of `time_from_start`, negative before its start.

    A hold and a stop count from their own start. A tuple, because one is made in every cycle.

    Attributes:
        reference_s: the trajectory's time, to which the reference belongs.
        feedback_s: the controller's time since the trajectory's start; more than `reference_s` if
            the speed was scaled down.
    """

    reference_s: float
    feedback_s: float

    @property
    def error_s(self) -> float:
        """How far the trajectory's time is ahead of the controller's."""
        return self.reference_s - self.feedback_s


class ControllerState:
    """The current set-points, measurements and commands. Loop thread only; copy to keep.

    Attributes:
        layout: the quantities of the rows below.
        values: all rows one after another, shape (rows, n); the next four are views of it.
        reference: the set-point.
        feedback: the measured motion.
        error: reference minus feedback.
        output: the commands.
        time_s: the controller's time.
        progress: progress of the trajectory.
        speed_scaling: the speed of trajectory time.
    """

    __slots__ = (
        "error",
        "feedback",
        "layout",
        "output",
        "progress",
        "reference",
        "speed_scaling",
        "time_s",
        "values",
    )

    def __init__(self, layout: StateLayout) -> None:
        """Allocate the arrays."""
        self.layout = layout
        parts = (layout.reference, layout.feedback, layout.error, layout.output)
        ends = np.cumsum([len(part) for part in parts])
        self.values = np.zeros((int(ends[-1]), len(layout.joints)))
        self.reference, self.feedback, self.error, self.output = np.split(self.values, ends[:-1])
        self.time_s = 0.0
        self.progress = Progress(0.0, 0.0)
        self.speed_scaling = 1.0

    def save_state(self) -> tuple[Any, ...]:
        """Return the numbers, the times and the speed."""
        return self.values, self.time_s, self.progress, self.speed_scaling

    def load_state(self, state: tuple[Any, ...]) -> None:
        """Set the numbers, the times and the speed."""
        self.values[:], self.time_s, self.progress, self.speed_scaling = state


@dataclass(frozen=True, slots=True)
class Feedback:
    """The feedback of a goal.

    Attributes:
        time_s: the controller's time.
        progress: progress of the trajectory.
        desired: rows as `StateLayout.reference`, shape (k, n).
        actual: rows as `StateLayout.feedback`.
        error: rows as `StateLayout.error`.
    """

    time_s: float
    progress: Progress
    desired: Array
    actual: Array
    error: Array


@dataclass(frozen=True, slots=True)
class QueriedState:
    """The set-point at a queried time.

    Attributes:
        message: why there is none; empty if there is one.
        motion: position, velocity and acceleration, shape (3, n). If there is no set-point: those
            of the trajectory's end for a later time, else the measured ones.
    """

    message: str
    motion: Array

    @property
    def success(self) -> bool:
        """Whether there is a set-point at that time."""
        return not self.message


class TrajectorySink(Protocol):
    """Receives states, feedback and results on the loop thread; it must return quickly."""

    def open(self, layout: StateLayout) -> None:
        """Prepare for states of this layout; called at each activation."""
        ...

    def publish_state(self, state: ControllerState) -> None:
        """Publish the state; called in every cycle, with the same object."""
        ...

    def publish_feedback(self, goal_id: object, feedback: Feedback) -> None:
        """Publish a goal's feedback; called `action_monitor_rate` times a second."""
        ...

    def finish_goal(self, goal_id: object, result: GoalResult) -> None:
        """End a goal; called once for each accepted goal, in the cycle in which it ends."""
        ...


class ActiveGoal:
    """Holds at most one goal, and sends feedback and the result. Loop thread only.

    Attributes:
        request: the goal, or None.
    """

    def __init__(
        self, sink: TrajectorySink | None, feedback_rate_hz: float, logger: logging.Logger
    ) -> None:
        self.request: GoalRequest | None = None
        self._sink = sink
        self._feedback = Schedule(feedback_rate_hz)
        self._logger = logger

    def start(self, goal: GoalRequest) -> None:
        """Set the goal; there must be no other."""
        self.request = goal
        self._feedback.restart()

    def save_state(self) -> tuple[Any, ...]:
        """Return the goal, and when its feedback is due."""
        return self.request, self._feedback.save_state()

    def load_state(self, state: tuple[Any, ...]) -> None:
        """Continue with a saved goal; a different one that is running is aborted."""
        goal, feedback = state
        if self.request is not None and (goal is None or goal.id != self.request.id):
            self.end(RESTORED)
        self.request = goal
        self._feedback.load_state(feedback)

    def give_feedback(self, state: ControllerState) -> None:
        """Publish the goal's feedback if it is due.

        Intervals are in the controller's time and counted from the goal's start, so the rate does
        not depend on the speed of the simulation.
        """
        if self.request is None or self._sink is None:
            return
        if not self._feedback.is_due(state.time_s):
            return
        self._sink.publish_feedback(
            self.request.id,
            Feedback(
                state.time_s,
                state.progress,
                state.reference.copy(),
                state.feedback.copy(),
                state.error.copy(),
            ),
        )

    def end(self, result: GoalResult, detail: str = "") -> None:
        """End the goal, if there is one; the detail is for the log."""
        if self.request is None:
            return
        goal, self.request = self.request, None
        level = logging.WARNING if result.outcome is GoalOutcome.ABORTED else logging.INFO
        message = result.message or f"Goal {result.outcome.value}"
        self._logger.log(level, "%s", f"{message}: {detail}" if detail else message)
        if self._sink is not None:
            self._sink.finish_goal(goal.id, result)
