"""One <model> of an SDF file, as the robot that it is: links, all fixed to the model's frame."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import DescriptionError
from arm_description.mesh_data import Color
from arm_description.resources import SCHEMES
from arm_description.robot import (
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
from arm_gazebo.robot.gazebo_materials import gazebo_color
from arm_gazebo.robot.link_geometry import DEFAULT_FRICTION
from arm_gazebo.sdf.auto_inertia import DEFAULT_DENSITY, AutoInertia
from arm_gazebo.sdf.element import SdfElement
from arm_gazebo.sdf.frames import SdfFrames, pose_of

SHAPES = ("box", "cylinder", "sphere", "capsule", "mesh", "plane")

DEFAULT_INERTIAL = Inertial(1.0, Pose(), (1.0, 0.0, 0.0, 1.0, 0.0, 1.0))
"""SDF's own, whatever the shape: 1 kg, and 1 kg m2 about every axis."""


@dataclass(frozen=True, slots=True)
class SdfPlane:
    """An infinite plane to be touched, or a finite one to be seen.

    Attributes:
        pose: in the model's frame; z is the normal.
        size: full sides of what is seen, None for what is touched.
        rgba: colour of what is seen.
        friction: of what is touched, at most 1.
    """

    pose: Pose
    size: tuple[float, float] | None = None
    rgba: Color | None = None
    friction: float = DEFAULT_FRICTION


@dataclass(frozen=True, slots=True)
class SdfModel:
    """A model: one rigid body, for joints that move are not read.

    Attributes:
        robot: the model's frame as root, named after the model, and `MODEL::LINK` for each link.
        frictions: by link, of each of its collisions, at most 1.
        automatic: the links whose inertia is to be computed; they have none in `robot`.
        planes: which no link of a robot can have.
        static: whether it is part of the world.
    """

    robot: Robot
    frictions: Mapping[str, tuple[float, ...]]
    automatic: Mapping[str, AutoInertia]
    planes: tuple[SdfPlane, ...]
    static: bool


def read_model(model: SdfElement, name: str, static: bool | None = None) -> SdfModel:
    """Return what a <model> describes.

    Args:
        model: the element.
        name: of the model in its world.
        static: overrides what the model says; None lets it be.

    Raises:
        WorldError: a value is not what it must be.
    """
    links = model.children("link")
    frames = _frames_in(model)
    said = model.flag("static")
    fixed = said if static is None else static
    read = [_LinkReader(link, f"{name}::{link.name}", frames) for link in links]
    planes = tuple(plane for reader in read for plane in reader.planes())
    if planes and not fixed:
        raise model.error("has a <plane>, and a plane cannot move; make the model <static>")
    names = [reader.name for reader in read]
    joints = tuple(
        Joint(f"{name}::fixed::{link.name}", "fixed", name, of, pose_of(frames.matrix(link)))
        for link, of in zip(links, names, strict=True)
    )
    try:
        robot = Robot(name, (Link(name), *(reader.link() for reader in read)), joints)
    except DescriptionError as error:
        raise model.error(f"is no model: {error}") from error
    frictions = {reader.name: reader.frictions() for reader in read}
    automatic = {reader.name: auto for reader in read if (auto := reader.auto_inertia())}
    return SdfModel(robot, frictions, automatic, planes, fixed)


def placement_offset(model: SdfElement, frame: str) -> NDArray[np.float64]:
    """Return a model's frame (4, 4) in the one of its frames that its pose places.

    Args:
        model: the element.
        frame: name of the placed one, "" for the model's own.

    Raises:
        WorldError: the model has no such frame.
    """
    return np.asarray(np.linalg.inv(_frames_in(model).named(frame, model)), np.float64)


def _frames_in(model: SdfElement) -> SdfFrames:
    # Joints are frames too, though nothing else of them is simulated.
    parts = (*model.aside("joint"), *model.children("link"), *model.children("frame"))
    return SdfFrames({part.name: part for part in parts})


class _LinkReader:
    """Reads one link; `name` is what it is called in the world."""

    def __init__(self, link: SdfElement, name: str, frames: SdfFrames) -> None:
        self._link = link
        self._frames = frames
        self.name = name

    def link(self) -> Link:
        """Return all of it but planes."""
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
        """Return the frictions of the link's collisions but planes."""
        return tuple(_friction(collision) for collision, _ in self._solids("collision"))

    def auto_inertia(self) -> AutoInertia | None:
        """Return what the link's inertia is to be computed from, None where it is given."""
        inertial = self._link.child("inertial")
        if inertial is None or not inertial.truth("auto"):
            return None
        usual = inertial.size("density") if inertial.child("density") else DEFAULT_DENSITY
        densities = tuple(
            collision.size("density") if collision.child("density") else usual
            for collision, _ in self._solids("collision")
        )
        return AutoInertia(densities, inertial.size("mass") if inertial.child("mass") else None)

    def planes(self) -> Iterator[SdfPlane]:
        """Yield the link's planes in the model's frame."""
        for kind in ("visual", "collision"):
            for shape in self._link.children(kind):
                plane = shape.at("geometry", "plane")
                if plane is None:
                    continue
                normal = np.array(plane.numbers("normal", 3, (0.0, 0.0, 1.0)))
                if not np.linalg.norm(normal):
                    raise plane.error("has a normal of no length")
                upright = np.eye(4)
                upright[:3, :3] = _turn_to(normal / np.linalg.norm(normal))
                frame = self._frames.matrix(self._link) @ self._frames.within(self._link, shape)
                pose = pose_of(frame @ upright)
                x, y = plane.numbers("size", 2, (1.0, 1.0))
                if kind == "visual":
                    yield SdfPlane(pose, (x, y), _color(shape))
                else:
                    yield SdfPlane(pose, friction=_friction(shape))

    def _solids(self, kind: str) -> Iterator[tuple[SdfElement, Geometry]]:
        for shape in self._link.children(kind):
            geometry = _geometry(shape.needed("geometry"))
            if geometry is not None:
                yield shape, geometry

    def _pose(self, part: SdfElement) -> Pose:
        return pose_of(self._frames.within(self._link, part))

    def _inertial(self) -> Inertial | None:
        inertial = self._link.child("inertial")
        if inertial is None:
            return DEFAULT_INERTIAL
        if inertial.truth("auto"):
            return None
        moments = inertial.child("inertia")
        keys = {"ixx": 1.0, "ixy": 0.0, "ixz": 0.0, "iyy": 1.0, "iyz": 0.0, "izz": 1.0}
        ixx, ixy, ixz, iyy, iyz, izz = (
            moments.number(key, default) if moments else default for key, default in keys.items()
        )
        mass = inertial.number("mass", 1.0)
        return Inertial(mass, self._pose(inertial), (ixx, ixy, ixz, iyy, iyz, izz))


def _geometry(element: SdfElement) -> Geometry | None:
    """Return a shape, None for a plane and for what is unknown, which is listed as unread."""
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
        # A plain path starts in the folder of the file that names it.
        uri = str(shape.source.parent.resolve() / uri)
    x, y, z = shape.numbers("scale", 3, (1.0, 1.0, 1.0))
    scale: Vector = (x, y, z)
    return Mesh(uri, scale)


def _color(visual: SdfElement) -> Color | None:
    material = visual.child("material")
    # The transparency of a visual comes on top of its colour's.
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

    Gazebo takes the lower coefficient of two shapes, so that more than the 1 of all that say
    nothing counts only where both have more. MuJoCo takes the higher one: a ground of 100, as
    Gazebo saves it, would hold every wheel and foot.
    """
    ode = collision.at("surface", "friction", "ode")
    mu = ode.number("mu", DEFAULT_FRICTION) if ode else DEFAULT_FRICTION
    return min(max(mu, 0.0), DEFAULT_FRICTION)


def _turn_to(normal: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a rotation (3, 3) that turns z to a unit vector."""
    side = np.eye(3)[int(np.argmin(np.abs(normal)))]
    x = np.cross(side, normal)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(normal, x), normal])
