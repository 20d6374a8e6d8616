"""Add the shapes of links: visuals, collisions and their bounds."""

import math
from collections.abc import Iterator

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.mesh.data import Color
from arm_description.transforms import rotation_from_rpy, wxyz_from_rpy
from arm_description.urdf.robot import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Link,
    Mesh,
    Pose,
    Sphere,
    Visual,
)
from arm_gazebo.build_report import BuildOutcome, BuildReport, Finding
from arm_gazebo.errors import MeshError
from arm_gazebo.mesh.library import MeshLibrary
from arm_gazebo.mesh.part import MIN_HALF_THICKNESS_M, MeshPart
from arm_gazebo.robot.collision_policy import CollisionMasks, with_self
from arm_gazebo.robot.gazebo_tags import GazeboTags
from arm_node.frozen import frozen

VISUAL_GROUP = 2
COLLISION_GROUP = 3
"""Groups as in MuJoCo's own models; its viewers show groups 0 to 2."""
DEFAULT_COLOR: Color = (0.7, 0.7, 0.7, 1.0)
PLACEHOLDER_COLOR: Color = (0.9, 0.2, 0.7, 1.0)
DEFAULT_FRICTION = 1.0
"""The default of both MuJoCo and Gazebo."""
PRIORITIES = 1_000_000
"""Number of friction levels below 1 that priorities distinguish."""
PLACEHOLDER_SIDE_M = 0.05
"""Side of the box that replaces an unavailable mesh: small, and in a conspicuous colour."""
MIN_SIZE_M = 1e-6


@frozen
class _Shape:
    """A geom without its pose: MuJoCo's type and half sizes, or the name of a mesh."""

    type: mujoco.mjtGeom
    size: tuple[float, float, float] = (0.0, 0.0, 0.0)
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    mesh: str = ""
    rgba: Color | None = None


class LinkGeometry:
    """Adds the shapes of links to bodies.

    Args:
        meshes: the model's meshes.
        default: default values; the world file's own defaults are for the world only.
        tags: friction, colours and self-collision in the description.
        masks: collision masks of links whose tags do not override them.
        strict: whether an unavailable mesh is an error.
        report: receives a warning for every shape that is replaced.
    """

    missing = BuildOutcome.REPAIRED
    """The outcome to report for an unavailable mesh."""

    def __init__(
        self,
        meshes: MeshLibrary,
        default: mujoco.MjsDefault,
        tags: GazeboTags,
        masks: CollisionMasks,
        strict: bool,
        report: BuildReport,
    ) -> None:
        self._meshes = meshes
        self._default = default
        self._tags = tags
        self._masks = masks
        self._strict = strict
        self._report = report
        self._reported: set[str] = set()
        self._listed: set[str] = set()

    def add(self, body: mujoco.MjsBody, link: Link) -> None:
        """Add the visuals and collisions of a link to its body.

        Raises:
            MeshError: a mesh is unavailable and `strict` is set.
        """
        tags = self._tags.link(link.name)
        masks = with_self(self._masks) if tags.self_collide else self._masks
        for visual in link.visuals:
            shapes = tuple(self._shapes(visual.geometry, link))
            # A file with several colours overrides the single colour of the URDF.
            colorful = len({shape.rgba for shape in shapes}) > 1
            for shape in shapes:
                geom = self._add_geom(body, visual.origin, shape)
                geom.group = VISUAL_GROUP
                geom.contype = geom.conaffinity = 0
                own = shape.rgba if colorful else _color(visual, shape)
                geom.rgba = tags.rgba or own or DEFAULT_COLOR
        for collision in link.collisions:
            for shape in self._hulls(collision.geometry, link):
                geom = self._add_geom(body, collision.origin, shape)
                geom.group = COLLISION_GROUP
                geom.contype, geom.conaffinity = masks.contype, masks.conaffinity
                if tags.friction is not None:
                    set_friction(geom, tags.friction)

    def bounds(self, link: Link) -> NDArray[np.float64] | None:
        """Return lowest and highest corner of the link's shapes in its frame, shape (2, 3).

        Unavailable meshes do not count; without any shape the result is None.
        """
        corners = [
            pose.matrix()[:3, :3] @ corner + pose.xyz
            for pose, geometry in _shapes_of(link)
            for corner in self._corners(geometry)
        ]
        return np.array([np.min(corners, axis=0), np.max(corners, axis=0)]) if corners else None

    def _corners(self, geometry: Geometry) -> list[NDArray[np.float64]]:
        try:
            low, high = self._box(geometry)
        except MeshError:
            return []
        return [np.where(choice, high, low) for choice in np.ndindex(2, 2, 2)]

    def _box(self, geometry: Geometry) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        match geometry:
            case Mesh():
                boxes = [part.bounds for part in self._meshes.parts(geometry)]
                return np.min([b[0] for b in boxes], axis=0), np.max([b[1] for b in boxes], axis=0)
            case Box(size):
                half = np.array(size) / 2
            case Sphere(radius):
                half = np.full(3, radius)
            case Cylinder(radius, length):
                half = np.array([radius, radius, length / 2])
            case Capsule(radius, length):
                half = np.array([radius, radius, length / 2 + radius])
        return -half, half

    def _shapes(self, geometry: Geometry, link: Link) -> Iterator[_Shape]:
        if not isinstance(geometry, Mesh):
            yield _primitive(geometry)
            return
        try:
            assets = self._meshes.assets(geometry, _where(link))
        except MeshError as error:
            yield self._placeholder(geometry, error, link)
            return
        self._report_triangles(geometry, link)
        for asset in assets:
            yield _Shape(mujoco.mjtGeom.mjGEOM_MESH, mesh=asset.name, rgba=asset.rgba)

    def _hulls(self, geometry: Geometry, link: Link) -> Iterator[_Shape]:
        """Yield collision shapes: MuJoCo computes a mesh's hull, but a flat mesh has none."""
        if not isinstance(geometry, Mesh):
            yield _primitive(geometry)
            return
        try:
            parts = self._meshes.parts(geometry)
        except MeshError as error:
            yield self._placeholder(geometry, error, link)
            return
        for part, asset in zip(parts, self._meshes.hulls(geometry, _where(link)), strict=True):
            if part.is_flat():
                yield self._flat(geometry, part, link)
            else:
                yield _Shape(mujoco.mjtGeom.mjGEOM_MESH, mesh=asset.name)

    def _flat(self, mesh: Mesh, part: MeshPart, link: Link) -> _Shape:
        """Return the collision shape for a mesh without a volume."""
        if part.lies_along_axes():
            shape, instead = _box_around(part), "its bounding box is used"
        else:
            asset = self._meshes.thickened(mesh, part, _where(link))
            shape = _Shape(mujoco.mjtGeom.mjGEOM_MESH, mesh=asset.name)
            instead = "it is made a little thicker"
        flat = "a part of its" if len(self._meshes.parts(mesh)) > 1 else "its"
        problem = f"{flat} collision mesh {mesh.uri} is flat; {instead}"
        self._report.repair(f"link '{link.name}'", problem, link.line)
        return shape

    def _add_geom(self, body: mujoco.MjsBody, origin: Pose, shape: _Shape) -> mujoco.MjsGeom:
        position = origin.xyz
        if any(shape.offset):
            position = np.add(position, rotation_from_rpy(origin.rpy) @ shape.offset)
        geom = body.add_geom(
            self._default, type=shape.type, pos=position, quat=wxyz_from_rpy(origin.rpy)
        )
        if shape.mesh:
            geom.meshname = shape.mesh
        else:
            geom.size = shape.size
        # Only the link's <inertial> contributes mass.
        geom.mass = 0.0
        return geom

    def _report_triangles(self, mesh: Mesh, link: Link) -> None:
        if mesh.uri in self._reported:
            return
        self._reported.add(mesh.uri)
        parts = self._meshes.parts(mesh)
        given, drawn = sum(p.triangles for p in parts), sum(len(p.drawn.faces) for p in parts)
        different = sum(p.different for p in parts)
        # Each triangle twice is usual: exporters show both sides of a sheet that way.
        if 2 * different < drawn:
            self._report.warn(
                f"link '{link.name}'",
                f"of the {drawn} triangles of its mesh {mesh.uri} only {different} are different; "
                "it was probably exported wrongly",
                link.line,
            )
        if drawn < given:
            self._report.inform(
                f"link '{link.name}'",
                f"its mesh {mesh.uri} has {given} triangles; {drawn} are drawn",
                link.line,
            )

    def _placeholder(self, mesh: Mesh, error: MeshError, link: Link) -> _Shape:
        element = f"link '{link.name}'"
        if self._strict:
            raise MeshError(f"{_where(link)}: {error}") from error
        if mesh.uri not in self._reported:
            self._reported.add(mesh.uri)
            message = f"{self._once_listed(mesh, error)} a box of 5 cm replaces it"
            self._report.add(Finding(self.missing, element, message, link.line))
        half = PLACEHOLDER_SIDE_M / 2
        return _Shape(mujoco.mjtGeom.mjGEOM_BOX, (half, half, half), rgba=PLACEHOLDER_COLOR)

    def _once_listed(self, mesh: Mesh, error: MeshError) -> str:
        """Return what is wrong; the places of a package that were searched are listed once."""
        reason, lists, _ = str(error).partition("; tried:")
        package = "/".join(mesh.uri.split("/")[:3])
        if lists and package in self._listed:
            return f"{reason} in the same folders, either;"
        if lists:
            self._listed.add(package)
        return f"{error}\n "


def _where(link: Link) -> str:
    return f"link '{link.name}' (line {link.line})"


def set_friction(geom: mujoco.MjsGeom, friction: float) -> None:
    """Set the sliding friction of a shape, and a priority that is higher for lower friction.

    Of two shapes in contact Gazebo uses the lower coefficient. MuJoCo uses the coefficient of the
    shape with the higher priority, and for equal priorities the higher coefficient.
    """
    geom.friction = [friction, *geom.friction[1:]]
    geom.priority = friction_priority(friction)


def friction_priority(friction: float) -> int:
    """Return the priority of a shape with this friction; see `set_friction`."""
    return math.ceil(max(DEFAULT_FRICTION - friction, 0.0) * PRIORITIES)


def _shapes_of(link: Link) -> Iterator[tuple[Pose, Geometry]]:
    """Yield the collisions of a link, or its visuals if it has no collisions."""
    for shape in link.collisions or link.visuals:
        yield shape.origin, shape.geometry


def _primitive(geometry: Box | Cylinder | Sphere | Capsule) -> _Shape:
    match geometry:
        case Box((x, y, z)):
            return _Shape(mujoco.mjtGeom.mjGEOM_BOX, _sizes(x / 2, y / 2, z / 2))
        case Cylinder(radius, length):
            return _Shape(mujoco.mjtGeom.mjGEOM_CYLINDER, _sizes(radius, length / 2))
        case Capsule(radius, length):
            return _Shape(mujoco.mjtGeom.mjGEOM_CAPSULE, _sizes(radius, length / 2))
        case Sphere(radius):
            return _Shape(mujoco.mjtGeom.mjGEOM_SPHERE, _sizes(radius))


def _sizes(*sizes: float) -> tuple[float, float, float]:
    """Return three half sizes; none is 0, because MuJoCo refuses shapes without a volume."""
    padded = [max(size, MIN_SIZE_M) for size in sizes] + [0.0] * (3 - len(sizes))
    return (padded[0], padded[1], padded[2])


def _box_around(part: MeshPart) -> _Shape:
    low, high = part.bounds
    half = np.maximum((high - low) / 2, MIN_HALF_THICKNESS_M).tolist()
    middle = ((low + high) / 2).tolist()
    return _Shape(mujoco.mjtGeom.mjGEOM_BOX, (half[0], half[1], half[2]), tuple(middle))


def _color(visual: Visual, shape: _Shape) -> Color | None:
    """Return a visual's colour: from the URDF, or else from the mesh file."""
    if visual.material is not None and visual.material.rgba is not None:
        return visual.material.rgba
    return shape.rgba
