"""What clients ask a gripper for, and what it is asked for once that is checked."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class GripperRequest:
    """A goal of the action as it comes in: nothing is checked yet.

    Attributes:
        id: whatever the client of the controller knows the goal by; it comes back with the result.
        positions: rad or m; exactly one number is right.
        efforts: N m or N; the most to spend, or nothing for the controller's own.
        velocities: rad/s or m/s; the fastest, or nothing for the controller's own.
    """

    id: Any
    positions: Sequence[float]
    efforts: Sequence[float] = ()
    velocities: Sequence[float] = ()


@dataclass(frozen=True, slots=True)
class GripperTarget:
    """What the joint shall do.

    Attributes:
        position: where it shall go, in rad or m.
        max_effort: the most to spend on the way, in N m or N.
        max_velocity: the fastest on the way, in rad/s or m/s.
    """

    position: float
    max_effort: float
    max_velocity: float


@dataclass(frozen=True, slots=True)
class GoalCancel:
    """A goal is to end."""

    goal_id: object
