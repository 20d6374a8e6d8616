"""Plans: where the joints are to be at each moment from now on.

Time counts from the plan's own start. Plans are immutable: sampling one, at any time and in any
order, changes nothing.
"""

from bisect import bisect_right
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from arm_control.joint_trajectory.angles import nearest_turn
from arm_control.joint_trajectory.motion import (
    ACCELERATION,
    POSITION,
    RESOLUTION_S,
    ROWS,
    VELOCITY,
    at_rest,
)
from arm_control.joint_trajectory.spline import Spline

Array = NDArray[np.float64]


class Plan(Protocol):
    """A function of time."""

    @property
    def end_s(self) -> float:
        """When the last point is reached; a plan without any way to go ends at 0 or before."""
        ...

    def sample(self, time_s: float) -> NDArray[np.float64]:
        """Return the motion at a time not before 0, shape (4, n); nothing in it is NaN."""
        ...


class SplinePlan:
    """From a start to the first way point, and on along a spline through all of them.

    The way to the first point is a polynomial of the degree that the point asks for: what the
    start does not tell of it counts as zero. A first point in the past is not gone back to.
    """

    __slots__ = ("_lead_end_s", "_lead_in", "_offset_s", "_spline", "end_s")

    def __init__(
        self, start: Array, first: Array, spline: Spline, first_s: float, offset_s: float
    ) -> None:
        """Lead into a spline.

        Args:
            start: motion at time 0, shape (4, n).
            first: motion at the spline's first point, shape (4, n).
            spline: through all way points.
            first_s: time of the first point in the spline's time.
            offset_s: this plan's time when the spline's is 0.
        """
        self._spline = spline
        self._offset_s = offset_s
        self._lead_end_s = offset_s + first_s
        self._lead_in = None
        if self._lead_end_s > RESOLUTION_S:
            ends = np.stack([np.nan_to_num(start), first])
            self._lead_in = Spline(np.array([0.0, self._lead_end_s]), ends)
        self.end_s = offset_s + spline.end_s

    def sample(self, time_s: float) -> NDArray[np.float64]:
        """Return the motion at a time."""
        if self._lead_in is not None and time_s + RESOLUTION_S < self._lead_end_s:
            return self._lead_in.sample(time_s)
        return self._spline.sample(time_s - self._offset_s)


class StepPlan:
    """Jumps to each way point at the moment when the one before is due."""

    __slots__ = ("_motions", "_times_s", "end_s")

    def __init__(self, start: Array, motions: Array, times_s: Array) -> None:
        """Line the points up.

        Args:
            start: motion until the first point is due, shape (4, n).
            motions: way points, shape (m, 4, n).
            times_s: when they are due, shape (m,).
        """
        self._motions = np.nan_to_num(np.concatenate([start[None], motions, motions[-1:]]))
        self._times_s: list[float] = times_s.tolist()
        self.end_s = self._times_s[-1]

    def sample(self, time_s: float) -> NDArray[np.float64]:
        """Return the motion at a time."""
        due = bisect_right(self._times_s, time_s + RESOLUTION_S)
        return self._motions[due + 1 if due else 0].copy()


class StopPlan:
    """Brings each joint to rest with a deceleration of its own, and keeps it there.

    A joint stops after |v| / a, having gone v |v| / (2 a).
    """

    __slots__ = ("_deceleration", "_position", "_rest", "_stop_s", "_velocity", "end_s")

    def __init__(self, position: Array, velocity: Array, deceleration: Array) -> None:
        """Take the state to stop from.

        Args:
            position: shape (n,).
            velocity: shape (n,).
            deceleration: positive, shape (n,).
        """
        self._position = position
        self._velocity = velocity
        self._deceleration = np.copysign(deceleration, velocity)
        self._stop_s = velocity / self._deceleration
        self.end_s = float(self._stop_s.max(initial=0.0))
        self._rest = at_rest(position + 0.5 * velocity * self._stop_s)

    @classmethod
    def hold(cls, position: Array) -> "StopPlan":
        """Stay where the joints are, at once."""
        return cls(position.copy(), np.zeros_like(position), np.ones_like(position))

    def sample(self, time_s: float) -> NDArray[np.float64]:
        """Return the motion at a time."""
        if time_s >= self.end_s:
            return self._rest.copy()
        t = np.minimum(self._stop_s, time_s)
        motion = np.zeros((ROWS, len(t)))
        motion[POSITION] = self._position + t * (self._velocity - 0.5 * t * self._deceleration)
        motion[VELOCITY] = self._velocity - t * self._deceleration
        motion[ACCELERATION] = np.where(time_s < self._stop_s, -self._deceleration, 0.0)
        return motion


class JoinedPlan:
    """A spline joined without a step in position, velocity or acceleration.

    What the joints are commanded to do differs from what the spline wants of them, be it that the
    spline is elsewhere, or that its first point is still to come: then it is prolonged backwards
    with that point's velocity. The difference is added to the spline, and fades to nothing along
    a quintic until the first point is due, or more slowly where there is little time for that.
    """

    __slots__ = ("_difference", "_first", "_lead_end_s", "_offset_s", "_spline", "end_s")

    def __init__(
        self,
        commanded: Array,
        spline: Spline,
        first_s: float,
        offset_s: float,
        least_s: float,
        continuous: NDArray[np.bool_],
    ) -> None:
        """Join a spline.

        Args:
            commanded: motion at time 0, shape (4, n).
            spline: through all way points.
            first_s: time of the first point in the spline's time.
            offset_s: this plan's time when the spline's is 0.
            least_s: time that the difference takes at least to fade; the plan ends no sooner.
            continuous: which joints turn without end, shape (n,): they join the short way.
        """
        self._spline = spline
        self._offset_s = offset_s
        self._lead_end_s = offset_s + first_s
        self._first = spline.sample(first_s)
        self._first[ACCELERATION] = 0.0
        ahead = spline.sample(max(first_s, -offset_s))
        start = commanded.copy()
        start[POSITION] = nearest_turn(start[POSITION], ahead[POSITION], continuous)
        difference = start - self._wanted(0.0)
        fade_s = max(least_s, self._lead_end_s)
        self._difference = Spline(
            np.array([0.0, fade_s]), np.stack([difference, np.zeros_like(difference)])
        )
        end_s = offset_s + spline.end_s
        self.end_s = max(end_s, fade_s) if difference.any() else end_s

    def sample(self, time_s: float) -> NDArray[np.float64]:
        """Return the motion at a time."""
        return self._wanted(time_s) + self._difference.sample(time_s)

    def _wanted(self, time_s: float) -> NDArray[np.float64]:
        lead_s = self._lead_end_s - time_s
        if lead_s <= RESOLUTION_S:
            return self._spline.sample(time_s - self._offset_s)
        motion = self._first.copy()
        motion[POSITION] -= lead_s * motion[VELOCITY]
        return motion
