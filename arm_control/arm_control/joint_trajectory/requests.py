"""What clients ask for, as it comes in: nothing here is checked yet."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

FIELDS = ("positions", "velocities", "accelerations", "effort")
"""The sequences of a way point, in the order of the rows of a motion."""


def as_rows(values: Sequence[Sequence[float]], columns: int) -> NDArray[np.float64]:
    """Return sequences of one length as an array of shape (m, columns).

    The numbers of a message are `array.array`s, which NumPy takes one by one thirty times slower.
    """
    flat = np.fromiter(chain.from_iterable(values), np.float64, len(values) * columns)
    return flat.reshape(len(values), columns)


@dataclass(frozen=True, slots=True)
class TrajectoryPoint:
    """A way point; each sequence has one number for each joint, or is empty.

    Attributes:
        time_from_start_s: when it is due, counted from the start of the trajectory.
        positions: rad or m.
        velocities: rad/s or m/s.
        accelerations: rad/s² or m/s².
        effort: N m or N.
    """

    time_from_start_s: float
    positions: Sequence[float] = ()
    velocities: Sequence[float] = ()
    accelerations: Sequence[float] = ()
    effort: Sequence[float] = ()


@dataclass(frozen=True, slots=True)
class TrajectoryRequest:
    """A trajectory.

    Attributes:
        joint_names: the joints, in the order of the points' numbers.
        points: the way points in the order of time.
        stamp_s: when it starts; 0 for at once.
    """

    joint_names: Sequence[str]
    points: Sequence[TrajectoryPoint]
    stamp_s: float = 0.0


@dataclass(frozen=True, slots=True)
class JointTolerance:
    """How far one joint may be off; 0 asks for the controller's own tolerance, -1 for none."""

    name: str
    position: float = 0.0
    velocity: float = 0.0
    acceleration: float = 0.0


@dataclass(frozen=True, slots=True)
class GoalRequest:
    """A goal of the action.

    Attributes:
        id: whatever the client of the controller knows the goal by; it comes back with the result.
        trajectory: what to do.
        path_tolerance: while the joints move.
        goal_tolerance: at the end.
        goal_time_tolerance_s: how late the end may be; 0 for the controller's own tolerance, -1
            for any time.
    """

    id: Any
    trajectory: TrajectoryRequest
    path_tolerance: Sequence[JointTolerance] = ()
    goal_tolerance: Sequence[JointTolerance] = ()
    goal_time_tolerance_s: float = 0.0
