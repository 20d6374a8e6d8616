"""Convert messages of simulation_interfaces to and from the core's data."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from inspect import iscoroutinefunction
from typing import Any

import numpy as np
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
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

from arm_description.transforms import rotation_from_quaternion, transform
from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.ros.topic import set_stamp
from arm_gazebo.world.changes import Matrix, quaternion_of
from arm_gazebo.world.entity import WORLD_FRAME, Category, EntityNote
from arm_gazebo.world.entity_motion import Box, EntityFilter, EntityMotion, Volume
from arm_gazebo.world.loading import NamedWorld
from arm_node.qos import SERVICE_QOS

Codes = Mapping[Refusal, int]
ServiceRow = tuple[Any, str, Callable[[Any, Any], Any], Codes]
"""Type, name and handler of a service, and its result codes for refusals beyond the common ones.

The handler takes request and response, and fills in the response; it raises RequestError to refuse.
"""
COMMON_CODES = {
    Refusal.UNSUPPORTED: Result.RESULT_FEATURE_UNSUPPORTED,
    Refusal.NOT_FOUND: Result.RESULT_NOT_FOUND,
    Refusal.INCORRECT_STATE: Result.RESULT_INCORRECT_STATE,
}
MAX_POINTS = 10_000
MIN_NORM = 1e-6


def create_services(node: Node, rows: Iterable[ServiceRow]) -> None:
    """Create a service for each row; a handler may be a coroutine.

    A coroutine gets its own callback group, because it blocks its group until it ends.
    """
    for type_, name, handler, codes in rows:
        is_coroutine = iscoroutinefunction(handler)
        callback = partial(_answer_later if is_coroutine else _answer, handler, codes)
        group = MutuallyExclusiveCallbackGroup() if is_coroutine else None
        node.create_service(type_, name, callback, qos_profile=SERVICE_QOS, callback_group=group)


def _answer(handler: Callable[[Any, Any], Any], codes: Codes, request: Any, response: Any) -> Any:
    with _refusals(response, codes):
        handler(request, response)
    return response


async def _answer_later(
    handler: Callable[[Any, Any], Any], codes: Codes, request: Any, response: Any
) -> Any:
    with _refusals(response, codes):
        await handler(request, response)
    return response


@contextmanager
def _refusals(response: Any, codes: Codes) -> Iterator[None]:
    """Set the result of a response: a success, unless the block refuses or sets another."""
    response.result.result = Result.RESULT_OK
    try:
        yield
    except RequestError as error:
        code = codes.get(error.refusal, COMMON_CODES.get(error.refusal))
        response.result.result = Result.RESULT_OPERATION_FAILED if code is None else code
        response.result.error_message = str(error)


def matrix_of(pose: Pose) -> Matrix:
    """Return the (4, 4) transform of a pose.

    Raises:
        RequestError: a number is not finite, or the quaternion has zero length.
    """
    p, q = pose.position, pose.orientation
    numbers = np.array([p.x, p.y, p.z, q.x, q.y, q.z, q.w])
    norm = float(np.linalg.norm(numbers[3:]))
    if not np.isfinite(numbers).all():
        raise RequestError(Refusal.INVALID_POSE, "the pose has a number that is not finite")
    if not MIN_NORM < norm < math.inf:
        raise RequestError(
            Refusal.INVALID_POSE,
            "the orientation is not a quaternion: its length is 0 or infinite",
        )
    return transform(rotation_from_quaternion(numbers[3:] / norm), numbers[:3])


def twist_of(twist: Twist) -> np.ndarray:
    """Return linear and angular velocity, shape (6,).

    Raises:
        RequestError: a number is not finite.
    """
    v, w = twist.linear, twist.angular
    numbers = np.array([v.x, v.y, v.z, w.x, w.y, w.z])
    if not np.isfinite(numbers).all():
        raise RequestError(Refusal.INVALID_POSE, "the twist has a number that is not finite")
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


def state_message(motion: EntityMotion) -> EntityState:
    """Return an entity's pose and velocity in the world; the acceleration is not set."""
    message = EntityState(pose=pose_message(motion.pose))
    message.header.frame_id = WORLD_FRAME
    set_stamp(message.header, motion.time_s)
    message.twist.linear = vector_message(motion.linear)
    message.twist.angular = vector_message(motion.angular)
    return message


def bounds_message(box: Box | None) -> Bounds:
    """Return a box, corners of shape (2, 3), with the upper corner first as the standard says."""
    if box is None:
        return Bounds(type=Bounds.TYPE_EMPTY)
    return Bounds(type=Bounds.TYPE_BOX, points=[vector_message(box[1]), vector_message(box[0])])


def info_message(note: EntityNote) -> EntityInfo:
    """Return the information about an entity."""
    return EntityInfo(
        category=EntityCategory(category=note.category.value),
        description=note.description,
        tags=list(note.tags),
    )


def note_of(info: EntityInfo) -> EntityNote:
    """Return a client's information about an entity; raise RequestError for a bad category."""
    return EntityNote(_category(info.category), info.description, tuple(info.tags))


def filter_of(filters: EntityFilters) -> EntityFilter:
    """Return a filter; raise RequestError if it is invalid."""
    return EntityFilter(
        filters.filter,
        frozenset(map(_category, filters.categories)),
        frozenset(filters.tags.tags),
        filters.tags.filter_mode == TagsFilter.FILTER_MODE_ALL,
        _volume(filters.bounds),
    )


def world_message(world: NamedWorld) -> WorldResource:
    """Return the message of a world."""
    return WorldResource(
        name=world.name, world_resource=Resource(uri=world.uri), description=world.description
    )


def _category(message: EntityCategory) -> Category:
    try:
        return Category(message.category)
    except ValueError as error:
        known = ", ".join(f"{category.value} {category.name}" for category in Category)
        raise RequestError(
            Refusal.FAILED, f"no category {message.category}; there are {known}"
        ) from error


def _volume(bounds: Bounds) -> Volume | None:
    """Return the volume of bounds; a convex hull counts as its bounding box."""
    if bounds.type == Bounds.TYPE_EMPTY:
        return None
    points = np.array([[p.x, p.y, p.z] for p in list(bounds.points)[:MAX_POINTS]]).reshape(-1, 3)
    least = 3 if bounds.type == Bounds.TYPE_CONVEX_HULL else 2
    if bounds.type not in (Bounds.TYPE_BOX, Bounds.TYPE_CONVEX_HULL, Bounds.TYPE_SPHERE):
        raise RequestError(Refusal.FAILED, f"no bounds of the type {bounds.type}; it is 0 to 3")
    if len(points) < least or not np.isfinite(points).all():
        raise RequestError(
            Refusal.FAILED,
            f"bounds of the type {bounds.type} take {least} finite points or more",
        )
    if bounds.type == Bounds.TYPE_SPHERE:
        return Volume(points[0], points[0], max(float(points[1, 0]), 0.0))
    return Volume(points.min(axis=0), points.max(axis=0))
