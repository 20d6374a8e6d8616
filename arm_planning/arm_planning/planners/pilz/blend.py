"""Two motions joined without a stop: near the point between them, one fades into the other.

The window is Pilz': it begins where the first motion enters the sphere of the blend radius for the
last time, and ends where the second leaves it. In the window the tip's position and rotation go
from those of the first motion to those of the second by a polynomial of degree five. The joints
follow by inverse kinematics from the same mean of both motions' joints, so arms of seven joints end
on the second motion, too.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_planning.errors import InvalidPlanError, PlanningError
from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.planners.pilz.tip_motion import even_cubics
from arm_planning.planners.pose_line import PoseLine
from arm_planning.timing.driven_spline import DrivenSpline
from arm_planning.trajectory import TimedTrajectory

Array = NDArray[np.float64]

SEARCH_S = 5e-3
"""Steps in which the ends of a window are looked for."""
POSES = 40
"""Poses in a window at which joint positions are computed."""


class DrivenMotion:
    """A trajectory as a function of time; it rests before and after."""

    def __init__(self, trajectory: TimedTrajectory) -> None:
        self.duration_s = trajectory.duration_s
        self._spline = DrivenSpline.of(trajectory)
        self._still = trajectory.positions[:1] if self.duration_s == 0.0 else None

    def positions(self, times_s: Array) -> Array:
        """Return joint positions, (k, n)."""
        if self._still is not None:
            return np.repeat(self._still, len(times_s), axis=0)
        return self._spline.sample(np.clip(times_s, 0.0, self.duration_s))[0]


@dataclass(frozen=True, slots=True, eq=False)
class Window:
    """The time in which one motion fades into the next, in the time of the first.

    Attributes:
        first, second: the motions.
        begin_s: when it begins.
        shift_s: when the second motion starts.
        end_s: when it ends.
        corrections: what inverse kinematics adds to the mean of the joints, (POSES + 1, n).
    """

    first: DrivenMotion
    second: DrivenMotion
    begin_s: float
    shift_s: float
    end_s: float
    corrections: Array

    def positions(self, times_s: Array) -> Array:
        """Return joint positions in the window, (k, n)."""
        share = (times_s - self.begin_s) / (self.end_s - self.begin_s)
        slopes = np.gradient(self.corrections, axis=0)
        slopes[[0, -1]] = 0.0
        return self._mean(times_s, share) + even_cubics(self.corrections, slopes, share)

    def _mean(self, times_s: Array, share: Array) -> Array:
        before = self.first.positions(times_s)
        after = self.second.positions(times_s - self.shift_s)
        return before + _fade(share)[:, None] * (after - before)


def window(
    first: DrivenMotion,
    second: DrivenMotion,
    radius_m: float,
    kinematics: InverseKinematics,
    name: str,
) -> Window:
    """Return the window of a blend.

    Args:
        first: ends where `second` begins.
        second: the next motion.
        radius_m: above 0.
        kinematics: of the group and the link whose path is blended.
        name: of the blend, for messages.

    Raises:
        PlanningError: INVALID_MOTION_PLAN: a motion lies within the sphere as a whole;
            NO_IK_SOLUTION: the tip cannot be placed on the way.
    """
    centre = np.array(
        kinematics.tip_pose(first.positions(np.array([first.duration_s]))[0]).position
    )
    entry_s = first.duration_s - _until_outside(
        first, kinematics, centre, radius_m, name, backward=True
    )
    exit_s = _until_outside(second, kinematics, centre, radius_m, name, backward=False)
    # Both motions leave the window at the same time, whichever part of it is the longer.
    shift_s = max(entry_s, first.duration_s - exit_s)
    empty = np.zeros((POSES + 1, len(kinematics.group.joints)))
    plain = Window(first, second, entry_s, shift_s, shift_s + exit_s, empty)
    return _corrected(plain, kinematics, name)


def _until_outside(
    motion: DrivenMotion,
    kinematics: InverseKinematics,
    centre: Array,
    radius_m: float,
    name: str,
    *,
    backward: bool,
) -> float:
    """Return how long a motion stays within a sphere around its start, or around its end."""
    count = max(2, int(np.ceil(motion.duration_s / SEARCH_S)) + 1)
    passed = np.linspace(0.0, motion.duration_s, count)
    states = motion.positions(motion.duration_s - passed if backward else passed)
    before = 0.0
    for time_s, q in zip(passed.tolist(), states, strict=True):
        distance = float(np.linalg.norm(np.array(kinematics.tip_pose(q).position) - centre))
        if distance >= radius_m:
            return before
        before = time_s
    side = "before" if backward else "after"
    raise InvalidPlanError(
        f"{name}: the motion {side} the blend stays within its radius of {radius_m:g} m; "
        "make the radius smaller"
    )


def _corrected(plain: Window, kinematics: InverseKinematics, name: str) -> Window:
    shares = np.linspace(0.0, 1.0, POSES + 1)
    times = plain.begin_s + shares * (plain.end_s - plain.begin_s)
    means = plain.positions(times)
    befores = plain.first.positions(times)
    afters = plain.second.positions(times - plain.shift_s)
    corrections = np.zeros_like(means)
    rows: Sequence[tuple[float, Array, Array, Array]] = list(
        zip(_fade(shares).tolist(), befores, afters, means, strict=True)
    )
    for index, (fade, before, after, mean) in enumerate(rows[1:-1], 1):
        pose = PoseLine(kinematics.tip_pose(before), kinematics.tip_pose(after)).at(fade)
        try:
            corrections[index] = kinematics.follow(pose, mean) - mean
        except PlanningError as error:
            raise PlanningError(error.code, f"{name}: {error}") from error
    return Window(plain.first, plain.second, plain.begin_s, plain.shift_s, plain.end_s, corrections)


def _fade(share: Array) -> Array:
    """Return a polynomial from 0 to 1 whose first two derivatives vanish at both ends."""
    return share**3 * (10.0 + share * (6.0 * share - 15.0))
