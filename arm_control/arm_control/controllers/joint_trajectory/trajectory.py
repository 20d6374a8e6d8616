"""Trajectories: the waypoints of a client, and their form in the controller."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from enum import Enum
from itertools import chain
from typing import overload

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.angles import nearest_turn
from arm_control.controllers.joint_trajectory.profiles import (
    ACCELERATION,
    POSITION,
    ROWS,
    VELOCITY,
    Array,
    JoinedProfile,
    MotionProfile,
    Spline,
    SplineProfile,
    StepProfile,
)
from arm_control.state.encoding import StateValue

FIELDS = ("positions", "velocities", "accelerations", "effort")
"""The sequences of a waypoint, in the order of a motion's rows."""


@dataclass(frozen=True, slots=True)
class TrajectoryPoint:
    """A waypoint; each sequence has one number per joint or is empty.

    Attributes:
        time_from_start_s: its time since the start of the trajectory.
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


@dataclass(frozen=True, slots=True, eq=False)
class WayPoints(Sequence[TrajectoryPoint]):
    """Waypoints as arrays, of which NumPy processes a hundred thousand in some milliseconds.

    A Python loop over as many takes most of a second, in which every other thread waits for the
    interpreter. Immutable.

    Attributes:
        times_s: time of each point, shape (m,).
        sizes: how many numbers each point has in each field, shape (m, 4).
        numbers: for each field, the numbers of all points one after another.
    """

    times_s: Array
    sizes: NDArray[np.intp]
    numbers: Sequence[Array]
    _ends: NDArray[np.intp] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        # The sum of each column of `sizes` is the length of that field.
        object.__setattr__(self, "numbers", tuple(self.numbers))
        object.__setattr__(self, "_ends", np.cumsum(self.sizes, axis=0))

    @classmethod
    def of(cls, points: Iterable[TrajectoryPoint]) -> "WayPoints":
        """Return points as arrays."""
        if isinstance(points, WayPoints):
            return points
        points = list(points)
        fields = [[getattr(point, field) for point in points] for field in FIELDS]
        sizes = np.array([[len(values) for values in field] for field in fields], dtype=np.intp)
        return cls(
            np.array([point.time_from_start_s for point in points], dtype=np.float64),
            sizes.T.reshape(-1, len(FIELDS)),
            # The numbers of a message are `array.array`s; converting them one by one takes 30 times
            # longer.
            [np.fromiter(chain.from_iterable(field), np.float64) for field in fields],
        )

    def given(self, kind: int, columns: int) -> tuple[NDArray[np.intp], Array]:
        """Return which points have numbers in one of FIELDS, and these numbers, (k, columns).

        Each point must have `columns` numbers or none.
        """
        return np.flatnonzero(self.sizes[:, kind]), self.numbers[kind].reshape(-1, columns)

    def __len__(self) -> int:
        return len(self.times_s)

    @overload
    def __getitem__(self, index: int) -> TrajectoryPoint: ...

    @overload
    def __getitem__(self, index: slice) -> Sequence[TrajectoryPoint]: ...

    def __getitem__(self, index: int | slice) -> TrajectoryPoint | Sequence[TrajectoryPoint]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        index = range(len(self))[index]
        ends, sizes = self._ends[index].tolist(), self.sizes[index].tolist()
        fields = [
            numbers[end - size : end].tolist()
            for numbers, end, size in zip(self.numbers, ends, sizes, strict=True)
        ]
        return TrajectoryPoint(float(self.times_s[index]), *fields)


@dataclass(frozen=True, slots=True)
class TrajectoryRequest:
    """A trajectory.

    Attributes:
        joint_names: the joints, in the order of the points' numbers.
        points: the waypoints in order of time; stored as `WayPoints`.
        stamp_s: start time; 0 starts at once.
    """

    joint_names: Sequence[str]
    points: Sequence[TrajectoryPoint]
    stamp_s: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", WayPoints.of(self.points))

    @property
    def way_points(self) -> WayPoints:
        """The points as arrays."""
        return WayPoints.of(self.points)


class Interpolation(Enum):
    """Interpolation between two waypoints; the value is the one of the parameter."""

    SPLINES = "splines"
    NONE = "none"


class Trajectory(StateValue):
    """Waypoints in the controller's order of joints; immutable.

    Everything that does not depend on the robot's state is computed here, on the client's thread.

    Attributes:
        stamp_s: start time; 0 starts at once.
        times_s: time of each point since the start, shape (m,).
        motions: the points, shape (m, 4, n); NaN for missing values.
        missing: joints that it does not name, shape (n,).
        is_provisional: whether its start time has yet to be checked.
    """

    __slots__ = (
        "_interpolation",
        "_spline",
        "is_provisional",
        "missing",
        "motions",
        "stamp_s",
        "times_s",
    )

    def __init__(
        self,
        request: TrajectoryRequest,
        joints: Sequence[str],
        interpolation: Interpolation = Interpolation.SPLINES,
        *,
        is_provisional: bool = False,
    ) -> None:
        """Convert a request.

        The request is valid, see `find_fault`; if `is_provisional`, its start time has yet to be
        checked.
        """
        columns = np.array([joints.index(name) for name in request.joint_names], dtype=np.intp)
        self.stamp_s = request.stamp_s
        self.is_provisional = is_provisional
        points = request.way_points
        self.times_s = points.times_s
        self.motions = np.full((len(points), ROWS, len(joints)), np.nan)
        for row in range(ROWS):
            given, numbers = points.given(row, len(columns))
            if len(given):
                self.motions[:, row][np.ix_(given, columns)] = numbers
        self.missing = np.ones(len(joints), dtype=np.bool_)
        self.missing[columns] = False
        self._interpolation = interpolation
        self._spline = None
        if interpolation is Interpolation.SPLINES and not self._has_open_positions():
            self._spline = Spline(self.times_s, self.motions)

    def offset_s(self, now_s: float) -> float:
        """Return the time from `now_s` to its start; negative if it should have started."""
        return self.stamp_s - now_s if self.stamp_s else 0.0

    def profile(
        self,
        now_s: float,
        start: Array,
        held_position: Array,
        continuous: NDArray[np.bool_],
        join_s: float = 0.0,
    ) -> MotionProfile:
        """Return the motion profile from now on.

        Args:
            now_s: time 0 of the profile.
            start: motion to start from, shape (4, n).
            held_position: positions of the joints that the trajectory does not name, shape (n,).
            continuous: which joints are continuous, shape (n,): they take the shortest rotation to
                the first point.
            join_s: time in which to join the spline without a step from `start`, which must be
                fully known then; 0 moves from `start` to the first point as upstream does.
        """
        offset_s = self.offset_s(now_s)
        motions, spline, first_s = self.motions, self._spline, float(self.times_s[0])
        if self.missing.any():
            motions = _hold_joints(motions, self.missing, held_position)
        if (spline is None or self.missing.any()) and np.isnan(motions[:, POSITION]).any():
            motions = integrate(self.times_s + offset_s, motions, start)
        moved = start.copy()
        moved[POSITION] = nearest_turn(start[POSITION], motions[0, POSITION], continuous)
        if self._interpolation is Interpolation.NONE:
            return StepProfile(moved, motions, self.times_s + offset_s)
        if spline is None:
            spline = Spline(self.times_s, motions)
        if join_s > 0.0:
            return JoinedProfile(start, spline, first_s, offset_s, join_s, continuous)
        return SplineProfile(moved, motions[0], spline, first_s, offset_s)

    def _has_open_positions(self) -> bool:
        return bool(np.isnan(self.motions[:, POSITION]).any())


def _hold_joints(motions: Array, held: NDArray[np.bool_], position: Array) -> Array:
    """Return waypoints (m, 4, n) whose `held` joints (n,), not all, stay at `position` (n,)."""
    motions = motions.copy()
    # Held joints get zeros where the others have numbers, so that the spline's degree stays the
    # same.
    leader = int(np.argmin(held))
    motions[:, :, held] = np.where(np.isnan(motions[:, :, leader]), np.nan, 0.0)[:, :, None]
    motions[:, POSITION, held] = position[held]
    return motions


def integrate(times_s: Array, motions: Array, start: Array) -> Array:
    """Return waypoints with missing positions integrated.

    A missing position is integrated from the velocities at this point and the previous one, by the
    trapezoidal rule; a missing velocity likewise from the accelerations. Missing values in the
    integrand count as 0. Shapes: the times since the start (m,), the waypoints (m, 4, n), and
    `start`, the motion before them, (4, n), whose position is known.
    """
    chain = np.concatenate([start[None], motions])
    # A first point in the past is not integrated from the start.
    halves = np.diff(times_s, prepend=min(0.0, times_s[0]))[:, None] / 2.0
    position, velocity, acceleration = (chain[:, row] for row in (POSITION, VELOCITY, ACCELERATION))
    open_position = np.isnan(position)
    open_velocity = open_position & np.isnan(velocity)
    acceleration[_and_before(open_velocity) & np.isnan(acceleration)] = 0.0
    velocity[_and_before(open_position) & ~open_velocity & np.isnan(velocity)] = 0.0
    velocity[:] = _accumulate(velocity, acceleration, halves, open_velocity)
    position[:] = _accumulate(position, velocity, halves, open_position)
    return chain[1:]


def _and_before(rows: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return these rows and each row before one of them."""
    wider = rows.copy()
    wider[:-1] |= rows[1:]
    return wider


def _accumulate(values: Array, rates: Array, halves: Array, is_open: NDArray[np.bool_]) -> Array:
    """Return values, shape (m + 1, n); each open one is the previous one plus its trapezoid."""
    steps = np.where(is_open[1:], (rates[:-1] + rates[1:]) * halves, 0.0)
    total = np.concatenate([np.zeros_like(values[:1]), np.cumsum(steps, axis=0)])
    rows = np.arange(len(values))[:, None]
    given = np.maximum.accumulate(np.where(is_open, 0, rows), axis=0)
    anchored = np.take_along_axis(values - total, given, axis=0)
    return np.where(is_open, anchored + total, values)
