"""The state that the controller reports in every cycle."""

from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.joint_trajectory.goals import GoalResult
from arm_control.controllers.joint_trajectory.parameters import InterfaceLayout
from arm_control.controllers.joint_trajectory.plans import EFFORT, QUANTITIES, ROWS

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
    desired: NDArray[np.float64]
    actual: NDArray[np.float64]
    error: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class QueriedState:
    """The set-point at a queried time.

    Attributes:
        message: why there is none; empty if there is one.
        motion: position, velocity and acceleration, shape (3, n). If there is no set-point: those
            of the trajectory's end for a later time, else the measured ones.
    """

    message: str
    motion: NDArray[np.float64]

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
