"""A joint trajectory that moves the tip along a curve with a trapezoid as its speed."""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import NoPlanError, PlanningError
from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.planners.pilz.cartesian_limits import CartesianLimits
from arm_planning.planners.pose_line import PoseLine
from arm_planning.robot.model import PlanningLimits
from arm_planning.timing.driven_spline import limit_violation
from arm_planning.timing.slowed_motion import within_limits
from arm_planning.trajectory import TimedTrajectory

Array = NDArray[np.float64]

STEP_M, STEP_RAD = 5e-3, 0.05
"""Distance of the poses at which joint positions are computed first."""
MOST_POSES = 20_000.0
"""Longer paths have longer steps; no arm reaches so far."""
DOUBLINGS = 5
"""How often their number is doubled while the tip leaves the curve between them."""
OFF_CURVE_M, OFF_CURVE_RAD = 1e-4, 1e-3
"""How far it may leave the curve."""
SHORTEST_M = 1e-9
"""Paths shorter than this are no motion."""


class PoseCurve(Protocol):
    """A motion of a frame in space."""

    @property
    def length_m(self) -> float:
        """How far its origin goes."""
        ...

    @property
    def angle_rad(self) -> float:
        """How far it turns."""
        ...

    def at(self, share: float) -> RigidTransform:
        """Return the pose at a share of the way, 0 to 1."""
        ...


def tip_motion(
    name: str,
    curve: PoseCurve,
    kinematics: InverseKinematics,
    start: Array,
    limits: CartesianLimits,
    velocity_scaling: float,
    acceleration_scaling: float,
) -> TimedTrajectory:
    """Return the trajectory along a curve.

    The tip keeps to its Cartesian limits. Where a joint could not follow within its own limits, the
    tip slows down. (Pilz refuses such motions.)

    Args:
        name: "LIN" or "CIRC", for messages.
        curve: begins at the tip's pose at `start`.
        kinematics: of the group and the tip.
        start: positions of the group, (n,).
        limits: the limits of the tip.
        velocity_scaling: fraction of the velocity limits to use.
        acceleration_scaling: fraction of the acceleration limits to use.

    Raises:
        PlanningError: NO_IK_SOLUTION: a pose on the way is out of reach; PLANNING_FAILED: a joint
            would have to jump; the message says where.
    """
    length = max(curve.length_m, limits.metres_per_rad * curve.angle_rad)
    group = kinematics.group
    if length < SHORTEST_M:
        rest = np.zeros((1, len(start)))
        return TimedTrajectory(group.joints, np.zeros(1), np.array([start]), rest, rest.copy())
    followed = _Followed(name, curve, kinematics, start)
    speed = _Trapezoid(
        length,
        velocity_scaling * limits.max_trans_vel,
        acceleration_scaling * limits.max_trans_acc,
        acceleration_scaling * -limits.max_trans_dec,
    )

    def nominal(times_s: Array) -> Array:
        return followed.positions(speed.distance(times_s) / length)

    found = within_limits(nominal, speed.duration_s, group, velocity_scaling, acceleration_scaling)
    return checked(name, found, group.limits, velocity_scaling, acceleration_scaling)


def checked(
    name: str,
    trajectory: TimedTrajectory,
    limits: tuple[PlanningLimits, ...],
    velocity_scaling: float,
    acceleration_scaling: float,
) -> TimedTrajectory:
    """Return a trajectory that holds the limits of its joints.

    Raises:
        PlanningError: PLANNING_FAILED: it does not hold them.
    """
    fault = limit_violation(
        trajectory,
        limits,
        velocity_scaling=velocity_scaling,
        acceleration_scaling=acceleration_scaling,
    )
    if fault:
        raise NoPlanError(f"{name}: {fault}")
    return trajectory


@dataclass(frozen=True, slots=True)
class _Trapezoid:
    """From rest to rest along a path, as fast as the limits allow: accelerate, cruise, brake.

    Attributes:
        length: how far it goes, above 0.
        velocity: largest speed, above 0.
        acceleration: above 0.
        deceleration: above 0.
    """

    length: float
    velocity: float
    acceleration: float
    deceleration: float

    @property
    def peak(self) -> float:
        """The largest speed that it reaches."""
        both = 1.0 / self.acceleration + 1.0 / self.deceleration
        return min(self.velocity, math.sqrt(2.0 * self.length / both))

    @property
    def duration_s(self) -> float:
        """How long it takes."""
        ramps = self.peak / self.acceleration + self.peak / self.deceleration
        return self.length / self.peak + 0.5 * ramps

    def distance(self, times_s: Array) -> Array:
        """Return how far it has gone at times from 0 to its duration."""
        up, down = self.peak / self.acceleration, self.peak / self.deceleration
        left = self.duration_s - times_s
        rising = 0.5 * self.acceleration * times_s**2
        falling = self.length - 0.5 * self.deceleration * left**2
        even = self.peak * (times_s - 0.5 * up)
        gone = np.where(times_s < up, rising, np.where(left < down, falling, even))
        return np.clip(gone, 0.0, self.length)


class _Followed:
    """Joint positions along a curve, on one branch of the inverse kinematics."""

    def __init__(
        self, name: str, curve: PoseCurve, kinematics: InverseKinematics, start: Array
    ) -> None:
        self._name, self._curve, self._kinematics = name, curve, kinematics
        poses = max(curve.length_m / STEP_M, curve.angle_rad / STEP_RAD)
        count = math.ceil(min(max(poses, 4.0), MOST_POSES))
        for _ in range(DOUBLINGS + 1):
            self._points = self._follow(start, count)
            self._slopes = np.gradient(self._points, axis=0, edge_order=2)
            if self._is_on_curve():
                return
            count *= 2
        changes = np.abs(np.diff(self._points, axis=0))
        step, joint = (int(each) for each in np.unravel_index(changes.argmax(), changes.shape))
        raise NoPlanError(
            f"{name}: joint '{kinematics.group.joints[joint]}' would have to jump by "
            f"{changes[step, joint]:.3g} {self._where(step / len(changes))}, near a singularity"
        )

    def positions(self, shares: Array) -> Array:
        """Return joint positions at shares of the way, (k, n)."""
        return even_cubics(self._points, self._slopes, shares)

    def _follow(self, start: Array, count: int) -> Array:
        points = [start]
        for number in range(1, count + 1):
            share = number / count
            try:
                points.append(self._kinematics.follow(self._curve.at(share), points[-1]))
            except PlanningError as error:
                raise PlanningError(
                    error.code, f"{self._name} stops {self._where(share)}: {error}"
                ) from error
        return np.array(points)

    def _is_on_curve(self) -> bool:
        """Return whether the tip stays near the curve half way between the points."""
        count = len(self._points) - 1
        shares = (np.arange(count) + 0.5) / count
        for share, q in zip(shares.tolist(), self.positions(shares), strict=True):
            off = PoseLine(self._kinematics.tip_pose(q), self._curve.at(share))
            if off.length_m > OFF_CURVE_M or off.angle_rad > OFF_CURVE_RAD:
                return False
        return True

    def _where(self, share: float) -> str:
        x, y, z = self._curve.at(share).position
        if self._curve.length_m > SHORTEST_M:
            gone, whole, unit = share * self._curve.length_m, self._curve.length_m, "m"
        else:
            gone, whole, unit = share * self._curve.angle_rad, self._curve.angle_rad, "rad"
        return f"{gone:.3f} of {whole:.3f} {unit} along its path, at ({x:.3f}, {y:.3f}, {z:.3f}) m"


def even_cubics(points: Array, slopes: Array, shares: Array) -> Array:
    """Return the values of cubics that meet points with given slopes, (k, n).

    Args:
        points: (m, n), at equal steps of the share from 0 to 1.
        slopes: change per step at each point, (m, n).
        shares: where, (k,), 0 to 1.
    """
    count = len(points) - 1
    index = np.clip((shares * count).astype(np.intp), 0, count - 1)
    t = (shares * count - index)[:, None]
    p0, p1, v0, v1 = points[index], points[index + 1], slopes[index], slopes[index + 1]
    bend = 3.0 * (p1 - p0) - 2.0 * v0 - v1
    return p0 + t * (v0 + t * (bend + t * (2.0 * (p0 - p1) + v0 + v1)))
