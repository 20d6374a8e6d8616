"""Read an SDF <model> as rigid bodies, each a robot whose links are fixed to one frame."""

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import DescriptionError, ResourceNotFoundError
from arm_description.mesh.data import Color
from arm_description.resources import SCHEMES, resolve_uri
from arm_description.urdf.joint_type import JointType
from arm_description.urdf.robot import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    Joint,
    Link,
    Material,
    Mesh,
    Pose,
    Robot,
    Sphere,
    Vector,
    Visual,
)
from arm_gazebo.robot.gazebo_tags import gazebo_color
from arm_gazebo.robot.link_geometry import DEFAULT_FRICTION
from arm_gazebo.sdf.auto_inertia import DEFAULT_DENSITY, AutoInertia
from arm_gazebo.sdf.element import SdfElement
from arm_gazebo.sdf.frames import SdfFrames
from arm_gazebo.sdf.rigid_bodies import RigidBody, rigid_bodies
from arm_gazebo.sdf.scope import Matrix, SdfScope
from arm_node.frozen import frozen

SHAPES = ("box", "cylinder", "sphere", "capsule", "mesh", "plane")

DEFAULT_INERTIAL = Inertial(1.0, Pose(), (1.0, 0.0, 0.0, 1.0, 0.0, 1.0))
"""SDF's default for any shape: 1 kg, and 1 kg m2 about every axis."""


@frozen
class SdfPlane:
    """An infinite collision plane, or a finite visual plane.

    Attributes:
        pose: pose in the frame of the rigid body; z is the normal.
        size: full side lengths of a visual plane, None for a collision plane.
        rgba: colour of a visual plane.
        friction: friction of a collision plane, at most 1.
    """

    pose: Pose
    size: tuple[float, float] | None = None
    rgba: Color | None = None
    friction: float = DEFAULT_FRICTION


@frozen
class SdfModel:
    """One rigid body of a model, usually the whole model: moving joints are not simulated.

    Attributes:
        robot: the body's frame as root, and a link called `MODEL::LINK` for each link.
        frame: (4, 4) pose of the body's frame in the frame of the model.
        frictions: by link, the friction of each collision, at most 1.
        automatic: the links whose inertia is computed; they have no inertia in `robot`.
        planes: the planes, which cannot be part of a robot's link.
        static: whether it is part of the world.
        weightless: names of the links on which gravity does not act.
    """

    robot: Robot
    frame: Matrix
    frictions: Mapping[str, tuple[float, ...]]
    automatic: Mapping[str, AutoInertia]
    planes: tuple[SdfPlane, ...]
    static: bool
    weightless: frozenset[str] = frozenset()


def read_model(scope: SdfScope, name: str, static: bool | None = None) -> tuple[SdfModel, ...]:
    """Return the rigid bodies that a <model> and the models in it describe.

    `static` overrides the model's <static>; None keeps it.

    Raises:
        WorldError: a value is invalid.
    """
    return tuple(_read_body(scope.element, body) for body in rigid_bodies(scope, name, static))


def _read_body(model: SdfElement, body: RigidBody) -> SdfModel:
    to_body = np.linalg.inv(body.frame)
    read = [
        _LinkReader(link, f"{part.name}::{link.name}", part.scope.frames, to_body @ part.frame)
        for part in body.parts
        for link in part.scope.links
    ]
    planes = tuple(plane for reader in read for plane in reader.planes())
    if planes and not body.static:
        raise model.error("has a <plane>, and a plane cannot move; make the model <static>")
    joints = tuple(
        Joint(
            f"{body.name}::fixed::{reader.name}",
            JointType.FIXED,
            body.name,
            reader.name,
            reader.pose(),
        )
        for reader in read
    )
    try:
        links = (Link(body.name), *(reader.link() for reader in read))
        robot = Robot(body.name, links, joints)
    except DescriptionError as error:
        raise model.error(f"is not a valid model: {error}") from error
    frictions = {reader.name: reader.frictions() for reader in read}
    automatic = {reader.name: auto for reader in read if (auto := reader.auto_inertia())}
    weightless = frozenset(reader.name for reader in read if reader.is_weightless())
    return SdfModel(robot, body.frame, frictions, automatic, planes, body.static, weightless)


class _LinkReader:
    """Reads one link.

    `model_frame` is the pose (4, 4) of its model in the rigid body.
    """

    def __init__(self, link: SdfElement, name: str, frames: SdfFrames, model_frame: Matrix) -> None:
        self._link = link
        self._frames = frames
        self._model_frame = model_frame
        self.name = name

    def pose(self) -> Pose:
        """Return the pose of the link in the rigid body."""
        return Pose.of(self._model_frame @ self._frames.matrix(self._link))

    def link(self) -> Link:
        """Return the link without its planes."""
        visuals = tuple(
            Visual(shape.name, self._pose(shape), geometry, Material("", _color(shape)))
            for shape, geometry in self._solids("visual")
        )
        collisions = tuple(
            Collision(shape.name, self._pose(shape), geometry)
            for shape, geometry in self._solids("collision")
        )
        return Link(self.name, self._inertial(), visuals, collisions, self._link.line)

    def frictions(self) -> tuple[float, ...]:
        """Return the frictions of the link's collisions, except planes."""
        return tuple(_friction(collision) for collision, _ in self._solids("collision"))

    def auto_inertia(self) -> AutoInertia | None:
        """Return the input for an automatic inertia, None if the link gives its inertia."""
        inertial = self._link.child("inertial")
        if inertial is None or not inertial.boolean("auto"):
            return None
        default = inertial.size("density") if inertial.child("density") else DEFAULT_DENSITY
        densities = tuple(
            collision.size("density") if collision.child("density") else default
            for collision, _ in self._solids("collision")
        )
        return AutoInertia(densities, inertial.size("mass") if inertial.child("mass") else None)

    def is_weightless(self) -> bool:
        """Return whether gravity does not act on the link."""
        return self._link.child("gravity") is not None and not self._link.flag("gravity")

    def planes(self) -> Iterator[SdfPlane]:
        """Yield the link's planes in the frame of the rigid body."""
        for kind in ("visual", "collision"):
            for shape in self._link.children(kind):
                plane = shape.at("geometry", "plane")
                if plane is None:
                    continue
                normal = np.array(plane.numbers("normal", 3, (0.0, 0.0, 1.0)))
                if not np.linalg.norm(normal):
                    raise plane.error("has a normal of zero length")
                upright = np.eye(4)
                upright[:3, :3] = _rotation_to(normal / np.linalg.norm(normal))
                frame = self._frames.matrix(self._link) @ self._frames.within(self._link, shape)
                pose = Pose.of(self._model_frame @ frame @ upright)
                x, y = plane.numbers("size", 2, (1.0, 1.0))
                if kind == "visual":
                    yield SdfPlane(pose, (x, y), _color(shape))
                else:
                    yield SdfPlane(pose, friction=_friction(shape))

    def _solids(self, kind: str) -> Iterator[tuple[SdfElement, Geometry]]:
        for shape in self._link.children(kind):
            geometry = _geometry(shape.required("geometry"))
            if geometry is not None:
                yield shape, geometry

    def _pose(self, part: SdfElement) -> Pose:
        return Pose.of(self._frames.within(self._link, part))

    def _inertial(self) -> Inertial | None:
        inertial = self._link.child("inertial")
        if inertial is None:
            return DEFAULT_INERTIAL
        if inertial.boolean("auto"):
            return None
        moments = inertial.child("inertia")
        keys = {"ixx": 1.0, "ixy": 0.0, "ixz": 0.0, "iyy": 1.0, "iyz": 0.0, "izz": 1.0}
        ixx, ixy, ixz, iyy, iyz, izz = (
            moments.number(key, default) if moments else default for key, default in keys.items()
        )
        mass = inertial.number("mass", 1.0)
        return Inertial(mass, self._pose(inertial), (ixx, ixy, ixz, iyy, iyz, izz))


def _geometry(element: SdfElement) -> Geometry | None:
    """Return a shape; None for a plane, and for an unknown shape, which is reported as unread."""
    shape = next((child for tag in SHAPES if (child := element.child(tag))), None)
    match shape.tag if shape else "":
        case "box" if shape:
            x, y, z = shape.numbers("size", 3)
            if min(x, y, z) <= 0:
                raise shape.error(f"has sides of {x:g}, {y:g}, {z:g} m; they must be above 0")
            return Box((x, y, z))
        case "cylinder" if shape:
            return Cylinder(shape.size("radius"), shape.size("length"))
        case "capsule" if shape:
            return Capsule(shape.size("radius"), shape.size("length"))
        case "sphere" if shape:
            return Sphere(shape.size("radius"))
        case "mesh" if shape:
            return _mesh(shape)
    return None


def _mesh(shape: SdfElement) -> Mesh:
    uri = shape.text("uri")
    if not uri:
        raise shape.error("needs a <uri>")
    if not uri.startswith((*SCHEMES, "/")) and "://" not in uri:
        # A plain path is relative to the folder of the file that names it.
        uri = str(shape.source.parent.resolve() / uri)
    elif uri.startswith("model://"):
        uri = _beside(uri, shape.source.parent.resolve())
    x, y, z = shape.numbers("scale", 3, (1.0, 1.0, 1.0))
    scale: Vector = (x, y, z)
    return Mesh(uri, scale)


def _beside(uri: str, folder: Path) -> str:
    """Return the path of a file in the model's folder or one beside it, else the URI."""
    try:
        return str(resolve_uri(uri, [folder, folder.parent]))
    except ResourceNotFoundError:
        return uri


def _color(visual: SdfElement) -> Color | None:
    material = visual.child("material")
    # A visual's transparency multiplies the alpha of its colour.
    opacity = 1.0 - min(max(visual.number("transparency", 0.0), 0.0), 1.0)
    if material is None:
        return None
    ambient, diffuse = material.child("ambient"), material.child("diffuse")
    color = diffuse or ambient
    if color is None:
        script = material.child("script")
        named = gazebo_color(script.text("name")) if script else None
        return named and (*named[:3], named[3] * opacity)
    r, g, b, a = np.clip(material.color(color.tag), 0.0, 1.0).tolist()
    return (r, g, b, a * opacity)


def _friction(collision: SdfElement) -> float:
    """Return the coefficient of the first direction, at most 1; MuJoCo has one for both.

    Of two shapes in contact Gazebo takes the lower coefficient, so a value above the default of 1
    matters only if both shapes have one. MuJoCo takes the higher one: the ground's 100 in worlds
    that Gazebo saved would hold every wheel and foot.
    """
    ode = collision.at("surface", "friction", "ode")
    mu = ode.number("mu", DEFAULT_FRICTION) if ode else DEFAULT_FRICTION
    return min(max(mu, 0.0), DEFAULT_FRICTION)


def _rotation_to(normal: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a rotation (3, 3) that turns z to a unit vector."""
    side = np.eye(3)[int(np.argmin(np.abs(normal)))]
    x = np.cross(side, normal)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(normal, x), normal])
