"""Constraints on the robot's joints and on the poses of its links, by MoveIt's rules."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum

from arm_description.urdf.robot import Sphere
from arm_node.rigid_transform import Quaternion, RigidTransform, Vector
from arm_planning.scene.objects import PlacedShape

JOINT_TOLERANCE = 1e-4
POSITION_TOLERANCE_M = 1e-4
ORIENTATION_TOLERANCE = 1e-3
"""MoveGroupInterface's defaults, rad and m."""


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
