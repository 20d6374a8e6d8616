"""Poses of a link that satisfy a goal's constraints on its position and orientation."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from arm_description.transforms import rotation_about, rotation_from_quaternion
from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_planning.constraints.constraints import (
    MotionConstraints,
    OrientationConstraint,
    OrientationError,
    PositionConstraint,
)
from arm_planning.constraints.evaluation import LinkPose
from arm_planning.constraints.regions import distance_outside
from arm_planning.scene.objects import PlacedShape
from arm_planning.scene.shapes import Cone, Shape, TriangleMesh

Array = NDArray[np.float64]

TRIES = 100
"""Points that are drawn from the box around a region until one is inside."""


def poses_of(
    goal: MotionConstraints, pose: LinkPose, q: Array, random: np.random.Generator | None
) -> Iterator[tuple[str, Array, bool]]:
    """Yield poses of the first link that a goal constrains.

    Constraints on further links only reject what inverse kinematics makes of these.

    Args:
        goal: the goal; it has a position or an orientation.
        pose: poses of links.
        q: a state, (n,), for what the goal leaves open, and for frames that are links.
        random: where to draw poses within the tolerances from; None for their middles, one for
            each region.

    Yields:
        The link, its pose in the planning frame, (4, 4), and whether any orientation will do.
    """
    link = goal.positions[0].link if goal.positions else goal.orientations[0].link
    position = next((each for each in goal.positions if each.link == link), None)
    orientation = next((each for each in goal.orientations if each.link == link), None)
    result = pose(q, link)
    if orientation is not None:
        result[:3, :3] = _in_planning_frame(orientation.frame, pose, q)[:3, :3] @ _rotation(
            orientation, random
        )
    if position is None:
        yield link, result, False
        return
    frame = _in_planning_frame(position.frame, pose, q)
    for point in _points(position, random):
        placed = result.copy()
        offset = placed[:3, :3] @ np.array(position.offset)
        placed[:3, 3] = frame[:3, :3] @ point + frame[:3, 3] - offset
        yield link, placed, orientation is None and not any(position.offset)


def _in_planning_frame(frame: str, pose: LinkPose, q: Array) -> Array:
    return pose(q, frame) if frame else np.eye(4)


def _points(position: PositionConstraint, random: np.random.Generator | None) -> Iterator[Array]:
    """Yield points of the regions, (3,), in their frame."""
    regions = position.regions
    if random is not None:
        regions = (regions[int(random.integers(len(regions)))],)
    for region in regions:
        rotation = rotation_from_quaternion(np.array(region.pose.rotation))
        yield rotation @ _local_point(region, random) + np.array(region.pose.position)


def _local_point(region: PlacedShape, random: np.random.Generator | None) -> Array:
    low, high = _bounds(region.shape)
    middle = (low + high) / 2.0
    if random is None:
        return middle
    for point in random.uniform(low, high, (TRIES, 3)):
        if distance_outside(region.shape, point) == 0.0:
            return point
    return middle


def _bounds(shape: Shape) -> tuple[Array, Array]:
    """Corners of a shape's bounding box in its frame; of a plane, the point nearest to it."""
    match shape:
        case Box():
            half = np.array(shape.size) / 2.0
        case Sphere():
            half = np.full(3, shape.radius)
        case Cylinder():
            half = np.array([shape.radius, shape.radius, shape.length / 2.0])
        case Cone():
            half = np.array([shape.radius, shape.radius, shape.height / 2.0])
        case TriangleMesh():
            return shape.vertices.min(axis=0), shape.vertices.max(axis=0)
        case _:
            normal = np.array([shape.a, shape.b, shape.c])
            point = -shape.d * normal / float(normal @ normal)
            return point, point
    return -half, half


def _rotation(each: OrientationConstraint, random: np.random.Generator | None) -> Array:
    """Return a rotation in the constraint's frame, (3, 3): the wanted one, or one near it."""
    wanted = rotation_from_quaternion(np.array(each.orientation))
    if random is None:
        return wanted
    tolerances = np.minimum(each.tolerances, np.pi)
    x, y, z = random.uniform(-tolerances, tolerances).tolist()
    if each.error is OrientationError.ROTATION_VECTOR:
        axes = rotation_from_quaternion(np.array(each.axes))
        return axes @ _about((x, y, z)) @ axes.T @ wanted
    return wanted @ _about((x, 0.0, 0.0)) @ _about((0.0, y, 0.0)) @ _about((0.0, 0.0, z))


def _about(vector: tuple[float, float, float]) -> Array:
    """Return the rotation by a rotation vector, (3, 3)."""
    angle = float(np.linalg.norm(vector))
    return rotation_about([each / (angle or 1.0) for each in vector], angle)
