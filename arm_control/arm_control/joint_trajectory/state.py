"""What the controller tells of itself in every cycle."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from arm_control.joint_trajectory.motion import EFFORT, QUANTITIES, ROWS
from arm_control.joint_trajectory.results import GoalResult
from arm_control.joint_trajectory.wiring import Wiring

MOTION_ROWS = 3
"""Position, velocity and acceleration are always in the reference."""


@dataclass(frozen=True, slots=True)
class StateLayout:
    """Which quantities stand in a `ControllerState`, each for every joint.

    Attributes:
        joints: their names.
        reference: quantities of the motion wanted: 'position', 'velocity', ...
        feedback: quantities measured.
        error: quantities of reference minus feedback; zero where only measured, not followed.
        output: quantities commanded.
    """

    joints: tuple[str, ...]
    reference: tuple[str, ...]
    feedback: tuple[str, ...]
    error: tuple[str, ...]
    output: tuple[str, ...]

    @classmethod
    def of(cls, wiring: Wiring) -> "StateLayout":
        """Return the layout for these interfaces."""
        measured = tuple(QUANTITIES[row] for row in wiring.state_rows)
        reference_rows = ROWS if EFFORT in wiring.command_rows else MOTION_ROWS
        return cls(
            joints=wiring.joints,
            reference=QUANTITIES[:reference_rows],
            feedback=measured,
            error=measured,
            output=tuple(QUANTITIES[row] for row in wiring.command_rows),
        )


class Progress(NamedTuple):
    """How far a trajectory has got, negative before its start; all that is `time_from_start`.

    A hold and a stop count from their own start. A tuple, since there is one in every cycle.

    Attributes:
        reference_s: the trajectory's time, which the reference belongs to.
        feedback_s: the controller's time since the trajectory's start; more than `reference_s`
            where the speed was scaled down.
    """

    reference_s: float
    feedback_s: float

    @property
    def error_s(self) -> float:
        """How far the trajectory is ahead of the clock."""
        return self.reference_s - self.feedback_s


class ControllerState:
    """The present state: wanted, measured, commanded. Loop thread; copy what is to be kept.

    Attributes:
        layout: what the rows below stand for.
        values: all rows one after another, shape (rows, n); the four below are views of it.
        reference: the motion wanted now.
        feedback: the motion measured.
        error: reference minus feedback.
        output: the commands.
        time_s: the controller's time.
        progress: how far the trajectory has got.
        speed_scaling: how fast trajectory time runs.
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
        """Make room."""
        self.layout = layout
        parts = (layout.reference, layout.feedback, layout.error, layout.output)
        ends = np.cumsum([len(part) for part in parts])
        self.values = np.zeros((int(ends[-1]), len(layout.joints)))
        self.reference, self.feedback, self.error, self.output = np.split(self.values, ends[:-1])
        self.time_s = 0.0
        self.progress = Progress(0.0, 0.0)
        self.speed_scaling = 1.0


@dataclass(frozen=True, slots=True)
class Feedback:
    """How a goal is getting on.

    Attributes:
        time_s: the controller's time.
        progress: how far the trajectory has got.
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
    """Answer to a question for the state at some time.

    Attributes:
        message: why there is none; empty where there is. Then the motion is the measured one.
        motion: position, velocity and acceleration, shape (3, n).
    """

    message: str
    motion: NDArray[np.float64]

    @property
    def success(self) -> bool:
        """Whether there is a state at that time."""
        return not self.message


class TrajectorySink(Protocol):
    """Where the controller's news go; called on the loop thread, so it must be quick."""

    def open(self, layout: StateLayout) -> None:
        """Get ready for states of this layout; called at each activation."""
        ...

    def publish_state(self, state: ControllerState) -> None:
        """Publish the state; called in every cycle, with the same object."""
        ...

    def publish_feedback(self, goal_id: object, feedback: Feedback) -> None:
        """Publish how the goal is getting on; called `action_monitor_rate` times a second."""
        ...

    def finish_goal(self, goal_id: object, result: GoalResult) -> None:
        """End a goal; called once for each goal that was taken, in the cycle of its end."""
        ...
