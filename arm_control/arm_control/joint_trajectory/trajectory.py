"""A trajectory as the controller keeps it."""

from collections.abc import Sequence
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from arm_control.joint_trajectory.angles import nearest_turn
from arm_control.joint_trajectory.completion import hold_joints, integrate
from arm_control.joint_trajectory.motion import POSITION, ROWS
from arm_control.joint_trajectory.plans import JoinedPlan, Plan, SplinePlan, StepPlan
from arm_control.joint_trajectory.requests import FIELDS, TrajectoryRequest, as_rows
from arm_control.joint_trajectory.spline import Spline


class Interpolation(Enum):
    """What happens between two way points; the value is that of the parameter."""

    SPLINES = "splines"
    NONE = "none"


class Trajectory:
    """Way points in the controller's order of joints; immutable.

    What needs no state of the robot is computed here, on the thread where the request comes in.

    Attributes:
        stamp_s: when it starts; 0 for at once.
        times_s: when each point is due after that, shape (m,).
        motions: the points, shape (m, 4, n); NaN where they leave something open.
        missing: joints that it does not name, shape (n,).
        is_provisional: whether what depends on the time has yet to be checked.
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
        """Take over a request.

        Args:
            request: without fault, see `find_fault`.
            joints: the controller's joints.
            interpolation: what happens between the points.
            is_provisional: whether what depends on the time has yet to be checked.
        """
        columns = [joints.index(name) for name in request.joint_names]
        self.stamp_s = request.stamp_s
        self.is_provisional = is_provisional
        self.times_s = np.array([point.time_from_start_s for point in request.points])
        self.motions = np.full((len(request.points), ROWS, len(joints)), np.nan)
        for row, field in enumerate(FIELDS):
            given = [(i, getattr(point, field)) for i, point in enumerate(request.points)]
            given = [(i, values) for i, values in given if len(values)]
            if given:
                where = np.ix_([i for i, _ in given], columns)
                self.motions[:, row][where] = as_rows([v for _, v in given], len(columns))
        self.missing = np.ones(len(joints), dtype=np.bool_)
        self.missing[columns] = False
        self._interpolation = interpolation
        self._spline = None
        if interpolation is Interpolation.SPLINES and not self._has_open_positions():
            self._spline = Spline(self.times_s, self.motions)

    def offset_s(self, now_s: float) -> float:
        """Return how long after a moment it starts: negative where it should have started."""
        return self.stamp_s - now_s if self.stamp_s else 0.0

    def plan(
        self,
        now_s: float,
        start: NDArray[np.float64],
        held_position: NDArray[np.float64],
        continuous: NDArray[np.bool_],
        join_s: float = 0.0,
    ) -> Plan:
        """Return what to do from now on.

        Args:
            now_s: time 0 of the plan.
            start: motion to start from, shape (4, n).
            held_position: where joints stay that the trajectory does not name, shape (n,).
            continuous: which joints turn without end, shape (n,): they go to the first point the
                short way.
            join_s: time in which to join the splines with no step from `start`, which is wholly
                known then; 0 to lead from it to the first point as upstream does.
        """
        offset_s = self.offset_s(now_s)
        motions, spline, first_s = self.motions, self._spline, float(self.times_s[0])
        if self.missing.any():
            motions = hold_joints(motions, self.missing, held_position)
        if np.isnan(motions[:, POSITION]).any():
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
