"""Arcs of the tip: through a point on the way, or about a centre."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_node.rigid_transform import RigidTransform, Vector
from arm_planning.errors import InvalidPlanError
from arm_planning.planners.pose_line import PoseLine

Array = NDArray[np.float64]

LARGEST_RADIUS_DIFFERENCE_M = 1e-2
"""By how much start and goal may differ in their distance from the centre."""
SMALLEST_RADIUS_M = 1e-6
COLLINEAR = 1e-5
"""Area in m^2 below which three points are on a line."""


@dataclass(frozen=True, slots=True, eq=False)
class PoseArc:
    """A motion of a frame along an arc; its rotation goes evenly from start to end.

    Attributes:
        ends: the poses at both ends.
        centre: (3,).
        outward: from the centre to the start, (3,).
        forward: as long, at a right angle, towards where the arc goes, (3,).
        turn_rad: angle of the arc, above 0.
        growth_m: by how much farther from the centre the end is.
    """

    ends: PoseLine
    centre: Array
    outward: Array
    forward: Array
    turn_rad: float
    growth_m: float = 0.0

    @property
    def length_m(self) -> float:
        """Length of the arc."""
        return float(np.linalg.norm(self.outward)) * self.turn_rad

    @property
    def angle_rad(self) -> float:
        """Angle between the rotations at the ends."""
        return self.ends.angle_rad

    def at(self, share: float) -> RigidTransform:
        """Return the pose at a share of the way, 0 to 1."""
        angle = share * self.turn_rad
        spoke = math.cos(angle) * self.outward + math.sin(angle) * self.forward
        radius = float(np.linalg.norm(self.outward))
        x, y, z = (self.centre + spoke * (1.0 + share * self.growth_m / radius)).tolist()
        return RigidTransform((x, y, z), self.ends.at(share).rotation)


def arc_through(start: RigidTransform, interim: Vector, goal: RigidTransform) -> PoseArc:
    """Return the arc from start to goal through a point.

    Raises:
        PlanningError: INVALID_MOTION_PLAN: the three points are on a line.
    """
    first, middle, last = _points(start, interim, goal)
    a, b = middle - first, last - first
    normal = np.cross(a, b)
    area = float(normal @ normal)
    if math.sqrt(area) < COLLINEAR:
        raise InvalidPlanError("the start, the interim point and the goal of CIRC are on a line")
    towards = (b @ b) * np.cross(normal, a) + (a @ a) * np.cross(b, normal)
    centre = first + towards / (2.0 * area)
    return _arc(start, goal, centre, normal / math.sqrt(area))


def arc_about(start: RigidTransform, centre: Vector, goal: RigidTransform) -> PoseArc:
    """Return the shorter arc from start to goal about a centre.

    Raises:
        PlanningError: INVALID_MOTION_PLAN: the centre is not as far from the start as from the
            goal, or the three points are on a line, as for half a circle.
    """
    first, middle, last = _points(start, centre, goal)
    radius, other = np.linalg.norm(first - middle), np.linalg.norm(last - middle)
    if abs(radius - other) > LARGEST_RADIUS_DIFFERENCE_M:
        raise InvalidPlanError(
            f"the centre of CIRC is {radius:.4f} m from the start and {other:.4f} m from the goal"
        )
    if min(radius, other) < SMALLEST_RADIUS_M:
        raise InvalidPlanError(f"the circle of CIRC is too small: its radius is {radius:.2g} m")
    normal = np.cross(first - middle, last - middle)
    size = float(np.linalg.norm(normal))
    if size < COLLINEAR:
        raise InvalidPlanError(
            "the start, the centre and the goal of CIRC are on a line, so the plane of the circle "
            "is open; give an interim point instead"
        )
    return _arc(start, goal, middle, normal / size)


def _arc(start: RigidTransform, goal: RigidTransform, centre: Array, axis: Array) -> PoseArc:
    first, last = np.array(start.position), np.array(goal.position)
    outward = first - centre
    radius = float(np.linalg.norm(outward))
    if radius < SMALLEST_RADIUS_M:
        raise InvalidPlanError(f"the circle of CIRC is too small: its radius is {radius:.2g} m")
    forward = np.cross(axis, outward)
    spoke = last - centre
    turn = math.atan2(float(spoke @ forward), float(spoke @ outward)) % (2.0 * math.pi)
    growth = float(np.linalg.norm(spoke)) - radius
    return PoseArc(PoseLine(start, goal), centre, outward, forward, turn, growth)


def _points(
    start: RigidTransform, point: Vector, goal: RigidTransform
) -> tuple[Array, Array, Array]:
    return np.array(start.position), np.array(point), np.array(goal.position)
