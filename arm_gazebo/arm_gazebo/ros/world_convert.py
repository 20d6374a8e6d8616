"""Messages of simulation_interfaces to and from what the simulation's core speaks."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3
from simulation_interfaces.msg import (
    Bounds,
    EntityCategory,
    EntityFilters,
    EntityInfo,
    EntityState,
    Resource,
    Result,
    TagsFilter,
    WorldResource,
)

from arm_description.transforms import transform
from arm_gazebo.ros.camera_publisher import set_stamp
from arm_gazebo.world.changes import Matrix, quaternion_of
from arm_gazebo.world.entity import WORLD_FRAME, Category, EntityNote
from arm_gazebo.world.entity_filter import EntityFilter, Volume
from arm_gazebo.world.entity_motion import Box, Motion
from arm_gazebo.world.loading import NamedWorld
from arm_gazebo.world.refusal import Refusal, RefusedError

COMMON_CODES = {
    Refusal.UNSUPPORTED: Result.RESULT_FEATURE_UNSUPPORTED,
    Refusal.NOT_FOUND: Result.RESULT_NOT_FOUND,
    Refusal.INCORRECT_STATE: Result.RESULT_INCORRECT_STATE,
}
Codes = Mapping[Refusal, int]
MOST_POINTS = 10_000
SMALLEST_NORM = 1e-6


def answer(response: Any, codes: Codes, action: Callable[[], None]) -> Any:
    """Do what was asked for and return the response, with how it ended.

    Args:
        response: has a `result`.
        codes: what the service calls refusals beside the common ones.
        action: fills in the rest of the response; raises RefusedError where it cannot.
    """
    try:
        action()
    except RefusedError as error:
        return refuse(response, codes, error)
    response.result.result = Result.RESULT_OK
    return response


def refuse(response: Any, codes: Codes, error: RefusedError) -> Any:
    """Return the response with why it is refused; see `answer`."""
    code = codes.get(error.refusal, COMMON_CODES.get(error.refusal))
    response.result.result = Result.RESULT_OPERATION_FAILED if code is None else code
    response.result.error_message = str(error)
    return response


def matrix_of(pose: Pose) -> Matrix:
    """Return the (4, 4) transform of a pose.

    Raises:
        RefusedError: a number is not finite, or the quaternion has no length.
    """
    p, q = pose.position, pose.orientation
    numbers = np.array([p.x, p.y, p.z, q.x, q.y, q.z, q.w])
    norm = float(np.linalg.norm(numbers[3:]))
    if not np.isfinite(numbers).all():
        raise RefusedError(Refusal.INVALID_POSE, "the pose has a number that is not finite")
    if not SMALLEST_NORM < norm < math.inf:
        raise RefusedError(
            Refusal.INVALID_POSE, "the orientation is no quaternion: its length is 0 or infinite"
        )
    x, y, z, w = (numbers[3:] / norm).tolist()
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    return transform(rotation, numbers[:3])


def twist_of(twist: Twist) -> np.ndarray:
    """Return linear and angular velocity, shape (6,).

    Raises:
        RefusedError: a number is not finite.
    """
    v, w = twist.linear, twist.angular
    numbers = np.array([v.x, v.y, v.z, w.x, w.y, w.z])
    if not np.isfinite(numbers).all():
        raise RefusedError(Refusal.INVALID_POSE, "the twist has a number that is not finite")
    return numbers


def pose_message(matrix: Matrix) -> Pose:
    """Return the pose of a (4, 4) transform."""
    x, y, z = matrix[:3, 3].tolist()
    w, i, j, k = quaternion_of(matrix).tolist()
    return Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=i, y=j, z=k, w=w))


def vector_message(vector: np.ndarray) -> Vector3:
    """Return a vector of shape (3,)."""
    x, y, z = vector.tolist()
    return Vector3(x=x, y=y, z=z)


def state_message(motion: Motion) -> EntityState:
    """Return where an entity is and how it moves, in the world; it tells no acceleration."""
    message = EntityState(pose=pose_message(motion.pose))
    message.header.frame_id = WORLD_FRAME
    set_stamp(message.header, motion.time_s)
    message.twist.linear = vector_message(motion.linear)
    message.twist.angular = vector_message(motion.angular)
    return message


def bounds_message(box: Box | None) -> Bounds:
    """Return a box, corners of shape (2, 3), the higher one first as the standard has it."""
    if box is None:
        return Bounds(type=Bounds.TYPE_EMPTY)
    return Bounds(type=Bounds.TYPE_BOX, points=[vector_message(box[1]), vector_message(box[0])])


def info_message(note: EntityNote) -> EntityInfo:
    """Return what is known about an entity."""
    return EntityInfo(
        category=EntityCategory(category=note.category.value),
        description=note.description,
        tags=list(note.tags),
    )


def note_of(info: EntityInfo) -> EntityNote:
    """Return what a client says about an entity; RefusedError for an unknown category."""
    return EntityNote(_category(info.category), info.description, tuple(info.tags))


def filter_of(filters: EntityFilters) -> EntityFilter:
    """Return a filter; RefusedError where it makes no sense."""
    return EntityFilter(
        filters.filter,
        frozenset(map(_category, filters.categories)),
        frozenset(filters.tags.tags),
        filters.tags.filter_mode == TagsFilter.FILTER_MODE_ALL,
        _volume(filters.bounds),
    )


def world_message(world: NamedWorld) -> WorldResource:
    """Return a world that is loaded or could be."""
    return WorldResource(
        name=world.name, world_resource=Resource(uri=world.uri), description=world.description
    )


def _category(message: EntityCategory) -> Category:
    try:
        return Category(message.category)
    except ValueError as error:
        known = ", ".join(f"{category.value} {category.name}" for category in Category)
        raise RefusedError(
            Refusal.FAILED, f"no category {message.category}; there are {known}"
        ) from error


def _volume(bounds: Bounds) -> Volume | None:
    """Return what entities have to reach into; the box around it stands for a hull of points."""
    if bounds.type == Bounds.TYPE_EMPTY:
        return None
    points = np.array([[p.x, p.y, p.z] for p in list(bounds.points)[:MOST_POINTS]]).reshape(-1, 3)
    least = 3 if bounds.type == Bounds.TYPE_CONVEX_HULL else 2
    if bounds.type not in (Bounds.TYPE_BOX, Bounds.TYPE_CONVEX_HULL, Bounds.TYPE_SPHERE):
        raise RefusedError(Refusal.FAILED, f"no bounds of the type {bounds.type}; it is 0 to 3")
    if len(points) < least or not np.isfinite(points).all():
        raise RefusedError(
            Refusal.FAILED, f"bounds of the type {bounds.type} take {least} finite points or more"
        )
    if bounds.type == Bounds.TYPE_SPHERE:
        return Volume(points[0], points[0], max(float(points[1, 0]), 0.0))
    return Volume(points.min(axis=0), points.max(axis=0))
