"""What makes an object unusable, as a sentence: a pose that is none, a shape without a size."""

import math
from collections.abc import Sequence

import numpy as np

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import Quaternion, RigidTransform
from arm_planning.errors import InvalidObjectError
from arm_planning.scene.objects import PlacedShape
from arm_planning.scene.shapes import Cone, Plane, Shape, TriangleMesh

UNIT = 1e-3
"""How far the norm of a quaternion may be from 1."""
SMALLEST_M = 1e-6
"""Least size of a shape, in m: MuJoCo refuses meshes, and so cones, of hardly any area."""
LARGEST_M = 1e6
"""Largest coordinate and size, in m; beyond it, numbers are too coarse, their squares too large."""


def vector_problem(vector: Sequence[float], what: str) -> str:
    """Return what is wrong with a point or a vector, in m, as a sentence about it; or ""."""
    if not all(map(math.isfinite, vector)):
        return f"{what} is not finite: {_listed(vector)}"
    if max(map(abs, vector)) > LARGEST_M:
        return f"{what} is beyond {LARGEST_M:g} m: {_listed(vector)}"
    return ""


def rotation_problem(quaternion: Quaternion, what: str) -> str:
    """Return what is wrong with a quaternion, as a sentence about whose it is; or ""."""
    norm = math.hypot(*quaternion)
    if abs(norm - 1.0) <= UNIT:
        return ""
    return (
        f"the orientation of {what} is no unit quaternion: its norm is {norm:.4g}; no rotation "
        "is (0, 0, 0, 1)"
    )


def pose_problem(pose: RigidTransform, what: str) -> str:
    """Return what is wrong with a pose, as a sentence; or ""."""
    position = vector_problem(pose.position, f"the position of {what}")
    return position or rotation_problem(pose.rotation, what)


def check_pose(pose: RigidTransform, what: str) -> None:
    """Refuse a pose that is none.

    Raises:
        PlanningError: INVALID_OBJECT_NAME: a number is not finite, or the quaternion is no unit
            one; `what` names the pose.
    """
    if problem := pose_problem(pose, what):
        raise InvalidObjectError(problem)


def check_shapes(shapes: Sequence[PlacedShape], owner: str) -> None:
    """Refuse shapes that have no size, a broken mesh or a pose that is none.

    Raises:
        PlanningError: INVALID_OBJECT_NAME; `owner` names the object, such as "object 'box1'".
    """
    for placed in shapes:
        problem = shape_problem(placed.shape)
        if problem:
            raise InvalidObjectError(f"{owner} has a {problem}")
        check_pose(placed.pose, f"a shape of {owner}")


def shape_problem(shape: Shape) -> str:
    """Return what is wrong with a shape, such as "box with a size that is not positive"; or ""."""
    match shape:
        case Box(size):
            return _size_problem("box", size)
        case Sphere(radius):
            return _size_problem("sphere", (radius,))
        case Cylinder(radius, length):
            return _size_problem("cylinder", (length, radius))
        case Cone(radius, height):
            return _size_problem("cone", (height, radius))
        case Plane(a, b, c, d):
            return _plane_problem((a, b, c), d)
        case TriangleMesh():
            return _mesh_problem(shape)


def _size_problem(name: str, sizes: Sequence[float]) -> str:
    if not all(math.isfinite(size) and size > 0.0 for size in sizes):
        return f"{name} with a size that is not positive: {_listed(sizes)}"
    if min(sizes) < SMALLEST_M or max(sizes) > LARGEST_M:
        bounds = f"{SMALLEST_M:g} m or above {LARGEST_M:g} m"
        return f"{name} with a size below {bounds}: {_listed(sizes)}"
    return ""


def _plane_problem(normal: Sequence[float], d: float) -> str:
    length = math.hypot(*normal)
    listed = _listed((*normal, d))
    if not (math.isfinite(length) and math.isfinite(d) and length > 0.0):
        return f"plane without a normal: {listed}"
    if not 1.0 / LARGEST_M <= length <= LARGEST_M or abs(d) > LARGEST_M * length:
        return f"plane that is too far away, or whose normal's length is far from 1: {listed}"
    return ""


def _mesh_problem(mesh: TriangleMesh) -> str:
    vertices, triangles = mesh.vertices, mesh.triangles
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        return f"mesh whose vertices have the shape {vertices.shape}, not (n, 3)"
    if triangles.ndim != 2 or triangles.shape[1] != 3 or not len(triangles):
        return "mesh without triangles"
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        wrong = int(triangles.max() if triangles.min() >= 0 else triangles.min())
        return f"mesh with {len(vertices)} vertices, of which a triangle uses number {wrong}"
    if not np.isfinite(vertices).all():
        return "mesh with a vertex that is not finite"
    if np.abs(vertices).max() > LARGEST_M:
        return f"mesh with a vertex beyond {LARGEST_M:g} m"
    corners = vertices[triangles]
    sides = corners[:, 1:] - corners[:, :1]
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum() / 2.0
    if area < SMALLEST_M**2:
        return "mesh whose triangles have hardly any area"
    return ""


def _listed(numbers: Sequence[float]) -> str:
    return ", ".join(f"{number:g}" for number in numbers)
