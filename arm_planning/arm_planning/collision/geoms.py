"""The shapes of links and objects as MuJoCo's geoms."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, hypot, isfinite, pi

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.transforms import wxyz_from_rpy
from arm_description.urdf.robot import Box, Capsule, Cylinder, Link, Mesh, Sphere
from arm_node.rigid_transform import Quaternion, RigidTransform, Vector
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.errors import InvalidObjectError, PlanningError
from arm_planning.scene.objects import CollisionObject
from arm_planning.scene.shapes import Cone, Plane, Shape, TriangleMesh

Array = NDArray[np.float64]
Placement = tuple[Vector, Quaternion]

MIN_SIZE_M = 1e-6
"""MuJoCo refuses shapes without a volume; a link's shape without a size gets this one."""
CONE_SIDES = 32
CUBE = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])


@dataclass(frozen=True, slots=True, eq=False)
class Geom:
    """A convex shape on a body.

    Attributes:
        type: MuJoCo's type.
        placement: its position and quaternion (w, x, y, z) in the frame of the body.
        size: half sizes, as MuJoCo has them.
        corners: of a piece of a mesh, (n, 3).
    """

    type: mujoco.mjtGeom
    placement: Placement
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
            return Geom(self.type, self.placement, corners=corners)
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
        return Geom(self.type, self.placement, size)


def link_geoms(link: Link, meshes: MeshPieces) -> tuple[Geom, ...]:
    """Return the collision shapes of a link; a mesh is the hull of each of its parts.

    Raises:
        PlanningError: a mesh cannot be used; the message names the link and the file.
    """
    try:
        return meshes.of(link, lambda link: tuple(_link_shapes(link, meshes)))
    except PlanningError as error:
        raise PlanningError(error.code, f"link '{link.name}': {error}") from error


def object_geoms(thing: CollisionObject, meshes: MeshPieces) -> tuple[Geom, ...]:
    """Return the shapes of an object in its frame.

    Raises:
        PlanningError: a shape has no size, or a mesh or a pose cannot be used; the message names
            the object.
    """
    try:
        return meshes.of(thing, lambda thing: tuple(_object_shapes(thing, meshes)))
    except PlanningError as error:
        raise PlanningError(error.code, f"object '{thing.id}': {error}") from error


def object_placement(thing: CollisionObject) -> Placement:
    """Return the position of an object and its quaternion (w, x, y, z).

    Raises:
        PlanningError: they are not valid; the message names the object.
    """
    try:
        return _placement(thing.pose)
    except PlanningError as error:
        raise PlanningError(error.code, f"object '{thing.id}': {error}") from error


def _placement(pose: RigidTransform) -> Placement:
    """Return MuJoCo's form of a pose; a quaternion of another length is normalised."""
    length = hypot(*pose.rotation)
    if not (isfinite(length) and all(map(isfinite, pose.position)) and length > 0.0):
        raise InvalidObjectError(f"it has no valid pose: {pose}")
    x, y, z, w = (part / length for part in pose.rotation)
    return pose.position, (w, x, y, z)


def _link_shapes(link: Link, meshes: MeshPieces) -> Iterator[Geom]:
    for collision in link.collisions:
        w, x, y, z = wxyz_from_rpy(collision.origin.rpy).tolist()
        placement = collision.origin.xyz, (w, x, y, z)
        match collision.geometry:
            case Mesh():
                for corners in meshes.of_file(collision.geometry):
                    yield Geom(mujoco.mjtGeom.mjGEOM_MESH, placement, corners=corners)
            case Capsule(radius, length):
                size = _sizes(radius, length / 2)
                yield Geom(mujoco.mjtGeom.mjGEOM_CAPSULE, placement, size)
            case Box() | Sphere() | Cylinder():
                yield _primitive(collision.geometry, placement)


def _primitive(shape: Box | Sphere | Cylinder, placement: Placement) -> Geom:
    match shape:
        case Box((x, y, z)):
            return Geom(mujoco.mjtGeom.mjGEOM_BOX, placement, _sizes(x / 2, y / 2, z / 2))
        case Sphere(radius):
            return Geom(mujoco.mjtGeom.mjGEOM_SPHERE, placement, _sizes(radius))
        case Cylinder(radius, length):
            return Geom(mujoco.mjtGeom.mjGEOM_CYLINDER, placement, _sizes(radius, length / 2))


def _object_shapes(thing: CollisionObject, meshes: MeshPieces) -> Iterator[Geom]:
    for placed in thing.shapes:
        yield from _object_shape(placed.shape, placed.pose, meshes)


def _object_shape(shape: Shape, pose: RigidTransform, meshes: MeshPieces) -> Iterator[Geom]:
    placement = _placement(pose)
    match shape:
        case TriangleMesh():
            for corners in meshes.of_object(shape):
                yield Geom(mujoco.mjtGeom.mjGEOM_MESH, placement, corners=corners)
        case Plane(a, b, c, d):
            placement = _placement(pose.then(_plane_pose(a, b, c, d)))
            yield Geom(mujoco.mjtGeom.mjGEOM_PLANE, placement, (1.0, 1.0, 1.0))
        case Cone(radius, height):
            _check_sizes("cone", radius, height)
            yield Geom(mujoco.mjtGeom.mjGEOM_MESH, placement, corners=_cone(radius, height))
        case Box(size):
            _check_sizes("box", *size)
            yield _primitive(shape, placement)
        case Sphere(radius):
            _check_sizes("sphere", radius)
            yield _primitive(shape, placement)
        case Cylinder(radius, length):
            _check_sizes("cylinder", radius, length)
            yield _primitive(shape, placement)


def _plane_pose(a: float, b: float, c: float, d: float) -> RigidTransform:
    """Return the pose of a plane of MuJoCo, whose z axis points out of the half space."""
    length = hypot(a, b, c)
    if not (isfinite(length) and isfinite(d) and length > 0.0):
        raise InvalidObjectError(f"a plane has no valid normal: {a:g}, {b:g}, {c:g}")
    quaternion = np.zeros(4)
    mujoco.mju_quatZ2Vec(quaternion, np.array([a, b, c]) / length)
    w, x, y, z = quaternion.tolist()
    scale = -d / length**2
    return RigidTransform((scale * a, scale * b, scale * c), (x, y, z, w))


def _cone(radius: float, height: float) -> Array:
    """Return the corners of a pyramid around a cone."""
    angles = np.arange(CONE_SIDES) * (2.0 * pi / CONE_SIDES)
    outer = radius / cos(pi / CONE_SIDES)
    base = np.column_stack([outer * np.cos(angles), outer * np.sin(angles), np.zeros(CONE_SIDES)])
    return np.vstack([base - (0.0, 0.0, height / 2), (0.0, 0.0, height / 2)])


def _check_sizes(kind: str, *sizes: float) -> None:
    if not all(isfinite(size) and size > 0.0 for size in sizes):
        given = " x ".join(f"{size:g}" for size in sizes)
        raise InvalidObjectError(f"a {kind} of {given} m is not a shape with a size")


def _sizes(*sizes: float) -> tuple[float, float, float]:
    padded = [max(size, MIN_SIZE_M) for size in sizes] + [0.0] * (3 - len(sizes))
    return (padded[0], padded[1], padded[2])
