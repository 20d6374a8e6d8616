"""Constraints on the robot's joints and on the poses of its links, by MoveIt's rules."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from enum import IntEnum

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import Quaternion, RigidTransform, Vector
from arm_planning.robot.model import JointGroup, PlanningLimits
from arm_planning.scene.objects import PlacedShape
from arm_planning.scene.shapes import Cone, Shape

JOINT_TOLERANCE = 1e-4
POSITION_TOLERANCE_M = 1e-4
ORIENTATION_TOLERANCE = 1e-3
"""MoveGroupInterface's defaults, rad and m."""
SNAPPED_TOLERANCE = 1e-9
"""Tolerance of a goal that was moved to a limit, rad or m."""


@dataclass(frozen=True, slots=True)
class JointConstraint:
    """A joint within [position - below, position + above], in rad or m."""

    joint: str
    position: float
    above: float
    below: float
    weight: float = 1.0


@dataclass(frozen=True, slots=True)
class PositionConstraint:
    """A point of a link inside one of several regions.

    Attributes:
        link: the link.
        offset: the point in the link's frame.
        regions: shapes with their poses in `frame`.
        frame: a link that the regions move with, or "" for the planning frame.
    """

    link: str
    offset: Vector
    regions: tuple[PlacedShape, ...]
    frame: str = ""
    weight: float = 1.0


class OrientationError(IntEnum):
    """How an orientation's error is measured; the values of moveit_msgs/OrientationConstraint."""

    XYZ_EULER_ANGLES = 0
    ROTATION_VECTOR = 1


@dataclass(frozen=True, slots=True)
class OrientationConstraint:
    """A link's orientation near a wanted one.

    Attributes:
        link: the link.
        orientation: the wanted orientation in `frame`.
        tolerances: largest error about x, y and z, in rad.
        error: how the error is measured.
        frame: a link that the orientation moves with, or "" for the planning frame.
        axes: how the axes x, y and z of a rotation vector's tolerances are turned in `frame`.
    """

    link: str
    orientation: Quaternion
    tolerances: Vector
    error: OrientationError = OrientationError.XYZ_EULER_ANGLES
    frame: str = ""
    weight: float = 1.0
    axes: Quaternion = (0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class MotionConstraints:
    """All of these hold at once."""

    joints: tuple[JointConstraint, ...] = ()
    positions: tuple[PositionConstraint, ...] = ()
    orientations: tuple[OrientationConstraint, ...] = ()
    name: str = ""

    def __bool__(self) -> bool:
        return bool(self.joints or self.positions or self.orientations)


def joint_goal(positions: Mapping[str, float]) -> MotionConstraints:
    """Return the goal that joints are at positions, rad or m."""
    return MotionConstraints(
        tuple(
            JointConstraint(joint, position, JOINT_TOLERANCE, JOINT_TOLERANCE)
            for joint, position in positions.items()
        )
    )


def pose_goal(link: str, pose: RigidTransform) -> MotionConstraints:
    """Return the goal that a link is at a pose in the planning frame."""
    place = PlacedShape(Sphere(POSITION_TOLERANCE_M), RigidTransform(pose.position))
    return MotionConstraints(
        positions=(PositionConstraint(link, (0.0, 0.0, 0.0), (place,)),),
        orientations=(
            OrientationConstraint(
                link,
                pose.rotation,
                (ORIENTATION_TOLERANCE, ORIENTATION_TOLERANCE, ORIENTATION_TOLERANCE),
                OrientationError.ROTATION_VECTOR,
            ),
        ),
    )


def tightened(constraints: MotionConstraints, share: float) -> MotionConstraints:
    """Return constraints with a share of their tolerances; meshes and half spaces stay."""
    return replace(
        constraints,
        joints=tuple(_tightened_joint(each, share) for each in constraints.joints),
        positions=tuple(_tightened_position(each, share) for each in constraints.positions),
        orientations=tuple(
            _tightened_orientation(each, share) for each in constraints.orientations
        ),
    )


def _tightened_joint(each: JointConstraint, share: float) -> JointConstraint:
    # The middle of the two tolerances stays where it is.
    middle = each.position + (each.above - each.below) / 2.0
    half = share * (each.above + each.below) / 2.0
    return replace(each, position=middle, above=half, below=half)


def _tightened_position(each: PositionConstraint, share: float) -> PositionConstraint:
    regions = tuple(
        replace(region, shape=_tightened_shape(region.shape, share)) for region in each.regions
    )
    return replace(each, regions=regions)


def _tightened_orientation(each: OrientationConstraint, share: float) -> OrientationConstraint:
    x, y, z = each.tolerances
    return replace(each, tolerances=(share * x, share * y, share * z))


def _tightened_shape(shape: Shape, share: float) -> Shape:
    match shape:
        case Box():
            x, y, z = shape.size
            return Box((share * x, share * y, share * z))
        case Sphere():
            return Sphere(share * shape.radius)
        case Cylinder():
            return Cylinder(share * shape.radius, share * shape.length)
        case Cone():
            return Cone(share * shape.radius, share * shape.height)
        case _:
            return shape


def snap_to_limits(
    goal: MotionConstraints, group: JointGroup, warn: Callable[[str], None]
) -> MotionConstraints:
    """Return a goal whose joints can be reached, as MoveIt does it.

    A joint whose whole tolerance is beyond a limit gets the limit as its goal, and `warn` is told.
    """
    limits = dict(zip(group.joints, group.limits, strict=True))
    joints = tuple(
        _snap(each, limits[each.joint], warn) if each.joint in limits else each
        for each in goal.joints
    )
    return replace(goal, joints=joints)


def _snap(
    goal: JointConstraint, limits: PlanningLimits, warn: Callable[[str], None]
) -> JointConstraint:
    if goal.position - goal.below > limits.upper:
        limit = limits.upper
    elif goal.position + goal.above < limits.lower:
        limit = limits.lower
    else:
        return goal
    warn(
        f"the goal of joint '{goal.joint}', {goal.position:.4g}, is beyond its limit; "
        f"{limit:.4g} is used"
    )
    return replace(goal, position=limit, above=SNAPPED_TOLERANCE, below=SNAPPED_TOLERANCE)
