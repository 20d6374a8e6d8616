"""The shapes of links and objects as MuJoCo's geoms."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, hypot, isfinite, pi

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.transforms import transform
from arm_description.urdf.robot import Box, Capsule, Cylinder, Geometry, Link, Mesh, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.errors import ErrorCode, PlanningError
from arm_planning.scene.objects import CollisionObject
from arm_planning.scene.shapes import Cone, Plane, Shape, TriangleMesh

Array = NDArray[np.float64]

MIN_SIZE_M = 1e-6
"""MuJoCo refuses shapes without a volume; a link's shape without a size gets this one."""
CONE_SIDES = 32
CUBE = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])


@dataclass(frozen=True, slots=True, eq=False)
class Geom:
    """A convex shape on a body.

    Attributes:
        type: MuJoCo's type.
        pose: its pose in the frame of the body, (4, 4).
        size: half sizes, as MuJoCo has them.
        corners: of a piece of a mesh, (n, 3).
    """

    type: mujoco.mjtGeom
    pose: Array
    size: tuple[float, float, float] = (0.0, 0.0, 0.0)
    corners: Array | None = None

    def grown(self, scale: float, padding_m: float) -> "Geom":
        """Return it scaled about its middle, then grown by a padding on all sides.

        A mesh grows into its sum with a cube, so nowhere by less than the padding.
        """
        if self.corners is not None:
            middle = self.corners.mean(axis=0)
            corners = middle + scale * (self.corners - middle)
            if padding_m:
                corners = (corners[:, None] + padding_m * CUBE).reshape(-1, 3)
            return Geom(self.type, self.pose, corners=corners)
        x, y, z = (scale * size for size in self.size)
        match self.type:
            case mujoco.mjtGeom.mjGEOM_BOX:
                size = _sizes(x + padding_m, y + padding_m, z + padding_m)
            case mujoco.mjtGeom.mjGEOM_CYLINDER:
                size = _sizes(x + padding_m, y + padding_m)
            case mujoco.mjtGeom.mjGEOM_CAPSULE:
                size = _sizes(x + padding_m, y)
            case _:
                size = _sizes(x + padding_m)
        return Geom(self.type, self.pose, size)


def link_geoms(link: Link, meshes: MeshPieces) -> tuple[Geom, ...]:
    """Return the collision shapes of a link; a mesh is the hull of each of its parts.

    Raises:
        PlanningError: a mesh cannot be used; the message names the link and the file.
    """
    try:
        return tuple(
            geom
            for collision in link.collisions
            for geom in _link_shape(collision.geometry, collision.origin.matrix(), meshes)
        )
    except PlanningError as error:
        raise PlanningError(error.code, f"link '{link.name}': {error}") from error


def object_geoms(thing: CollisionObject, meshes: MeshPieces) -> tuple[Geom, ...]:
    """Return the shapes of an object in its frame.

    Raises:
        PlanningError: a shape has no size, or a mesh or a pose cannot be used; the message names
            the object.
    """
    try:
        return tuple(
            geom
            for placed in thing.shapes
            for geom in _object_shape(placed.shape, _pose_matrix(placed.pose), meshes)
        )
    except PlanningError as error:
        raise PlanningError(error.code, f"object '{thing.id}': {error}") from error


def object_pose(thing: CollisionObject) -> Array:
    """Return the pose of an object as a (4, 4) matrix.

    Raises:
        PlanningError: it is not valid; the message names the object.
    """
    try:
        return _pose_matrix(thing.pose)
    except PlanningError as error:
        raise PlanningError(error.code, f"object '{thing.id}': {error}") from error


def _pose_matrix(pose: RigidTransform) -> Array:
    """Return a pose as a (4, 4) matrix; a quaternion of another length is normalised."""
    length = hypot(*pose.rotation)
    if not (isfinite(length) and all(map(isfinite, pose.position)) and length > 0.0):
        raise PlanningError(ErrorCode.INVALID_OBJECT_NAME, f"it has no valid pose: {pose}")
    x, y, z, w = (part / length for part in pose.rotation)
    return np.array(RigidTransform(pose.position, (x, y, z, w)).matrix())


def _link_shape(geometry: Geometry, pose: Array, meshes: MeshPieces) -> Iterator[Geom]:
    match geometry:
        case Mesh():
            for corners in meshes.of_file(geometry):
                yield Geom(mujoco.mjtGeom.mjGEOM_MESH, pose, corners=corners)
        case Capsule(radius, length):
            yield Geom(mujoco.mjtGeom.mjGEOM_CAPSULE, pose, _sizes(radius, length / 2))
        case _:
            yield _primitive(geometry, pose)


def _primitive(shape: Box | Sphere | Cylinder, pose: Array) -> Geom:
    match shape:
        case Box((x, y, z)):
            return Geom(mujoco.mjtGeom.mjGEOM_BOX, pose, _sizes(x / 2, y / 2, z / 2))
        case Sphere(radius):
            return Geom(mujoco.mjtGeom.mjGEOM_SPHERE, pose, _sizes(radius))
        case Cylinder(radius, length):
            return Geom(mujoco.mjtGeom.mjGEOM_CYLINDER, pose, _sizes(radius, length / 2))


def _object_shape(shape: Shape, pose: Array, meshes: MeshPieces) -> Iterator[Geom]:
    match shape:
        case TriangleMesh():
            for corners in meshes.of_object(shape):
                yield Geom(mujoco.mjtGeom.mjGEOM_MESH, pose, corners=corners)
        case Plane(a, b, c, d):
            yield Geom(mujoco.mjtGeom.mjGEOM_PLANE, pose @ _plane_pose(a, b, c, d), (1.0, 1.0, 1.0))
        case Cone(radius, height):
            _check_sizes("cone", radius, height)
            yield Geom(mujoco.mjtGeom.mjGEOM_MESH, pose, corners=_cone(radius, height))
        case Box(size):
            _check_sizes("box", *size)
            yield _primitive(shape, pose)
        case Sphere(radius):
            _check_sizes("sphere", radius)
            yield _primitive(shape, pose)
        case Cylinder(radius, length):
            _check_sizes("cylinder", radius, length)
            yield _primitive(shape, pose)


def _plane_pose(a: float, b: float, c: float, d: float) -> Array:
    """Return the pose of a plane of MuJoCo, whose z axis points out of the half space."""
    normal = np.array([a, b, c])
    length = float(np.linalg.norm(normal))
    if not (isfinite(length) and isfinite(d) and length > 0.0):
        raise PlanningError(
            ErrorCode.INVALID_OBJECT_NAME, f"a plane has no valid normal: {a:g}, {b:g}, {c:g}"
        )
    z = normal / length
    quaternion, rotation = np.zeros(4), np.zeros(9)
    mujoco.mju_quatZ2Vec(quaternion, z)
    mujoco.mju_quat2Mat(rotation, quaternion)
    return transform(rotation.reshape(3, 3), -d / length * z)


def _cone(radius: float, height: float) -> Array:
    """Return the corners of a pyramid around a cone."""
    angles = np.arange(CONE_SIDES) * (2.0 * pi / CONE_SIDES)
    outer = radius / cos(pi / CONE_SIDES)
    base = np.column_stack([outer * np.cos(angles), outer * np.sin(angles), np.zeros(CONE_SIDES)])
    return np.vstack([base - (0.0, 0.0, height / 2), (0.0, 0.0, height / 2)])


def _check_sizes(kind: str, *sizes: float) -> None:
    if not all(isfinite(size) and size > 0.0 for size in sizes):
        given = " x ".join(f"{size:g}" for size in sizes)
        raise PlanningError(
            ErrorCode.INVALID_OBJECT_NAME, f"a {kind} of {given} m is not a shape with a size"
        )


def _sizes(*sizes: float) -> tuple[float, float, float]:
    padded = [max(size, MIN_SIZE_M) for size in sizes] + [0.0] * (3 - len(sizes))
    return (padded[0], padded[1], padded[2])
