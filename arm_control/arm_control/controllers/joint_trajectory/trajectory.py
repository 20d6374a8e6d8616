"""A trajectory in the controller's form."""

from collections.abc import Sequence
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.angles import nearest_turn
from arm_control.controllers.joint_trajectory.goals import TrajectoryRequest
from arm_control.controllers.joint_trajectory.plans import (
    ACCELERATION,
    POSITION,
    ROWS,
    VELOCITY,
    JoinedPlan,
    MotionPlan,
    Spline,
    SplinePlan,
    StepPlan,
)
from arm_control.state.encoding import StateValue

Array = NDArray[np.float64]


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

        Args:
            request: a valid request, see `find_fault`.
            joints: the controller's joints.
            interpolation: interpolation between the points.
            is_provisional: whether its start time has yet to be checked.
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

    def plan(
        self,
        now_s: float,
        start: NDArray[np.float64],
        held_position: NDArray[np.float64],
        continuous: NDArray[np.bool_],
        join_s: float = 0.0,
    ) -> MotionPlan:
        """Return the motion plan from now on.

        Args:
            now_s: time 0 of the plan.
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
            return StepPlan(moved, motions, self.times_s + offset_s)
        if spline is None:
            spline = Spline(self.times_s, motions)
        if join_s > 0.0:
            return JoinedPlan(start, spline, first_s, offset_s, join_s, continuous)
        return SplinePlan(moved, motions[0], spline, first_s, offset_s)

    def _has_open_positions(self) -> bool:
        return bool(np.isnan(self.motions[:, POSITION]).any())


def _hold_joints(motions: Array, held: NDArray[np.bool_], position: Array) -> NDArray[np.float64]:
    """Return waypoints in which some joints are held.

    Args:
        motions: waypoints, shape (m, 4, n).
        held: which joints are held, shape (n,); at least one is not.
        position: their positions, shape (n,); other joints' values are ignored.
    """
    motions = motions.copy()
    # Held joints get zeros where the others have numbers, so that the spline's degree stays the
    # same.
    leader = int(np.argmin(held))
    motions[:, :, held] = np.where(np.isnan(motions[:, :, leader]), np.nan, 0.0)[:, :, None]
    motions[:, POSITION, held] = position[held]
    return motions


def integrate(times_s: Array, motions: Array, start: Array) -> NDArray[np.float64]:
    """Return waypoints with missing positions integrated.

    A missing position is integrated from the velocities at this point and the previous one, by the
    trapezoidal rule; a missing velocity likewise from the accelerations. Missing values in the
    integrand count as 0.

    Args:
        times_s: times of the waypoints since the start, shape (m,).
        motions: waypoints, shape (m, 4, n).
        start: motion before the first one, shape (4, n); its position is known.
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


def _accumulate(
    values: Array, rates: Array, halves: Array, is_open: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """Return values, shape (m + 1, n); each open one is the previous one plus its trapezoid."""
    steps = np.where(is_open[1:], (rates[:-1] + rates[1:]) * halves, 0.0)
    total = np.concatenate([np.zeros_like(values[:1]), np.cumsum(steps, axis=0)])
    rows = np.arange(len(values))[:, None]
    given = np.maximum.accumulate(np.where(is_open, 0, rows), axis=0)
    anchored = np.take_along_axis(values - total, given, axis=0)
    return np.where(is_open, anchored + total, values)
