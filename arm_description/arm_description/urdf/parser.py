"""Parses URDF text into a Robot.

Elements for other readers (<gazebo>, <ros2_control>, <transmission>) and unknown ones are ignored;
known ones are fully checked.
"""

import logging
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from arm_description.errors import UrdfError
from arm_description.urdf.description import Description, RobotDescription, as_description
from arm_description.urdf.element import Remark, UrdfElement
from arm_description.urdf.joint_type import JointType
from arm_description.urdf.robot import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Dynamics,
    Geometry,
    Inertial,
    Joint,
    JointLimit,
    Link,
    Material,
    Mesh,
    Mimic,
    Robot,
    SafetyLimits,
    Sphere,
    Vector,
    Visual,
)
from arm_node.names import listing

_logger = logging.getLogger(__name__)
_DEFAULT_AXIS: Vector = (1.0, 0.0, 0.0)

WORLDS = {
    "mujoco": ". MuJoCo's XML is a world: world:=FILE, or world=FILE in Python",
    "sdf": ". SDF is a world or a model: world:=FILE, or arm sim spawn FILE",
}
"""What to do with other files, by their outermost element."""


def _log(remark: Remark) -> None:
    _logger.warning("%s", remark)


def ignore_remark(_remark: Remark) -> None:
    """Ignore a remark, because another reader of the same description reports it."""


def parse_urdf(
    description: Description,
    source: str = "robot_description",
    remark: Callable[[Remark], None] = _log,
) -> Robot:
    """Parse a URDF.

    Args:
        description: the URDF; a xacro file must be expanded first (`expand_xacro`). A document
            keeps the robot: the next call returns it without a second reading.
        source: name of a text in messages.
        remark: receives problems that are not errors; by default they are logged.

    Raises:
        XmlError: the text is not XML.
        UrdfError: it is not a robot; the message names source, line and element.
    """
    document = as_description(description, source)
    try:
        return document.read(_read_robot)
    except UrdfError as error:
        raise type(error)(f"{document.source}, {error}") from error
    finally:
        while document.remarks:
            remark(document.remarks.pop(0))


def _read_robot(description: RobotDescription) -> Robot:
    root = description.root
    if description.is_wrapped:
        root.warn("is inside a <urdf>, which ROS's own parser does not accept; it is read anyway")
    _warn_of_foreign(description)
    if root.tag != "robot":
        hint = WORLDS.get(root.tag, "")
        raise root.error(f"is not a robot; a URDF's outermost element is <robot>{hint}")
    name = root.needed_text("name")
    links = [read_link(link) for link in description.links]
    return Robot(
        name=name,
        links=_resolve_materials(links, map(_read_material, description.materials)),
        joints=tuple(_read_joints(description.joints)),
    )


def _warn_of_foreign(description: RobotDescription) -> None:
    """Report the elements that ROS's own parser silently ignores."""
    groups: dict[str, list[int]] = {}
    for element in (description.root, *description.root.inside()):
        if element.is_foreign:
            groups.setdefault(element.tag, []).append(element.line)
    for name, lines in groups.items():
        why = (
            "was not expanded by xacro"
            if name.startswith("xacro:")
            else "has a prefix that is not declared"
        )
        others = f" (and {len(lines) - 1} more)" if len(lines) > 1 else ""
        description.remarks.append(Remark(lines[0], f"<{name}>", f"{why}{others}; it is ignored"))


def _read_joints(elements: Sequence[UrdfElement]) -> Iterator[Joint]:
    """Yield the joints; those that mimic a joint that does not exist move by themselves.

    ROS's own parser accepts them.
    """
    joints = [read_joint(element) for element in elements]
    names = [joint.name for joint in joints]
    for element, joint in zip(elements, joints, strict=True):
        if joint.mimic is None or joint.mimic.joint in names:
            yield joint
            continue
        element.warn(
            f"mimics joint '{joint.mimic.joint}', which does not exist; it moves by itself. The "
            f"robot has {listing(names)}"
        )
        yield replace(joint, mimic=None)


def read_link(element: UrdfElement) -> Link:
    """Read a <link>; a material that is only named has only a name.

    Raises:
        UrdfError: naming element and line.
    """
    name = element.needed_text("name")
    inertial = element.child("inertial")
    return Link(
        name=name,
        inertial=None if inertial is None else _read_inertial(inertial),
        visuals=tuple(_read_visual(visual) for visual in element.children("visual")),
        collisions=tuple(_read_collision(shape) for shape in element.children("collision")),
        line=element.line,
    )


def _read_material(element: UrdfElement) -> Material:
    """Read a <material>; without colour and texture it has only a name.

    Raises:
        UrdfError: a colour is not four numbers.
    """
    color = element.child("color")
    texture = element.child("texture")
    rgba = None
    if color is not None:
        values = color.numbers("rgba", 4)
        red, green, blue, alpha = (min(max(value, 0.0), 1.0) for value in values)
        rgba = (red, green, blue, alpha)
        if rgba != values:
            color.warn(f"has rgba='{color.text('rgba', '')}'; values are clamped to 0 to 1")
    # A texture without a file counts as none, as in urdfdom.
    file = "" if texture is None else texture.text("filename")
    return Material(name=element.text("name", ""), rgba=rgba, texture=file or None)


def _resolve_materials(links: Sequence[Link], materials: Iterable[Material]) -> tuple[Link, ...]:
    """Replace materials that are only named with their definitions.

    Args:
        links: the links as read.
        materials: the robot's materials. They take precedence over definitions in visuals, of which
            the first one wins.
    """
    used = (visual.material for link in links for visual in link.visuals)
    defined: dict[str, Material] = {}
    for material in [*materials, *used]:
        # A material without a name defines nothing, so its colour is not used for other visuals.
        if material is not None and material.name and _is_defined(material):
            defined.setdefault(material.name, material)
    return tuple(
        replace(link, visuals=tuple(_resolve(visual, defined) for visual in link.visuals))
        if any(v.material is not None and not _is_defined(v.material) for v in link.visuals)
        else link
        for link in links
    )


def _is_defined(material: Material) -> bool:
    return material.rgba is not None or material.texture is not None


def _resolve(visual: Visual, defined: Mapping[str, Material]) -> Visual:
    if visual.material is None or _is_defined(visual.material):
        return visual
    return replace(visual, material=defined.get(visual.material.name, visual.material))


def _read_inertial(element: UrdfElement) -> Inertial:
    inertia = element.needed_child("inertia")
    return Inertial(
        mass=element.needed_child("mass").size("value"),
        origin=element.origin(),
        inertia=(
            inertia.number("ixx"),
            inertia.number("ixy", 0.0),
            inertia.number("ixz", 0.0),
            inertia.number("iyy"),
            inertia.number("iyz", 0.0),
            inertia.number("izz"),
        ),
    )


def _read_visual(element: UrdfElement) -> Visual:
    material = element.child("material")
    return Visual(
        name=element.text("name", ""),
        origin=element.origin(),
        geometry=_read_geometry(element),
        material=None if material is None else _read_material(material),
    )


def _read_collision(element: UrdfElement) -> Collision:
    return Collision(element.text("name", ""), element.origin(), _read_geometry(element))


def _read_geometry(owner: UrdfElement) -> Geometry:
    geometry = owner.needed_child("geometry")
    shapes = list(geometry.children(*_SHAPES))
    if not shapes:
        raise geometry.error(f"has no shape; it takes one of {', '.join(_SHAPES)}")
    if len(shapes) > 1:
        geometry.warn(f"has {len(shapes)} shapes; the first one is used, <{shapes[0].tag}>")
    return _SHAPES[shapes[0].tag](shapes[0])


def _read_box(element: UrdfElement) -> Box:
    size = element.vector("size")
    if min(size) < 0.0:
        raise element.error(f"has size='{element.text('size', '')}'; no side may be negative")
    return Box(size)


def _read_mesh(element: UrdfElement) -> Mesh:
    return Mesh(element.needed_text("filename"), element.vector("scale", (1.0, 1.0, 1.0)))


_SHAPES = {
    "box": _read_box,
    "cylinder": lambda e: Cylinder(e.size("radius"), e.size("length")),
    "sphere": lambda e: Sphere(e.size("radius")),
    "capsule": lambda e: Capsule(e.size("radius"), e.size("length")),
    "mesh": _read_mesh,
}


def read_joint(element: UrdfElement) -> Joint:
    """Read a <joint>.

    Raises:
        UrdfError: naming element and line.
    """
    name = element.needed_text("name")
    kind = _read_type(element)
    return Joint(
        name=name,
        type=kind,
        parent=element.needed_child("parent").needed_text("link"),
        child=element.needed_child("child").needed_text("link"),
        origin=element.origin(),
        axis=_read_axis(element, kind),
        limit=_read_limit(element, kind),
        dynamics=_read_dynamics(element),
        mimic=_read_mimic(element),
        safety=_read_safety(element),
        line=element.line,
    )


def _read_type(element: UrdfElement) -> JointType:
    name = element.needed_text("type")
    try:
        return JointType(name)
    except ValueError:
        raise element.error(f"has type '{name}'; the types are {', '.join(JointType)}") from None


def _read_axis(element: UrdfElement, kind: JointType) -> Vector:
    axis = element.child("axis")
    if axis is None or not kind.has_axis:
        return _DEFAULT_AXIS
    x, y, z = axis.vector("xyz", _DEFAULT_AXIS)
    # hypot does not overflow or underflow like the sum of squares.
    length = math.hypot(x, y, z)
    if not 0.0 < length < math.inf:
        raise axis.error(f"is '{axis.text('xyz', '')}', which is not a direction")
    return x / length, y / length, z / length


def _read_limit(element: UrdfElement, kind: JointType) -> JointLimit | None:
    limit = element.child("limit")
    if limit is None:
        if kind.needs_limit:
            raise element.error(f"is {kind} and needs a <limit>")
        return None
    if not kind.is_scalar:
        return None
    lower, upper = -math.inf, math.inf
    if kind.needs_limit:
        lower, upper = limit.number("lower", 0.0), limit.number("upper", 0.0)
    if lower > upper:
        limit.warn(f"has lower={lower:g} above upper={upper:g}; they are swapped")
        lower, upper = upper, lower
    return JointLimit(lower, upper, _read_bound(limit, "effort"), _read_bound(limit, "velocity"))


def _read_bound(limit: UrdfElement, attribute: str) -> float:
    """Return the effort or velocity limit; 0 means no limit, as in ros2_control."""
    value = limit.number(attribute)
    if value < 0.0:
        limit.warn(f"has {attribute}={value:g}; a negative number sets no limit")
    return max(value, 0.0)


def _read_dynamics(element: UrdfElement) -> Dynamics:
    dynamics = element.child("dynamics")
    if dynamics is None:
        return Dynamics()
    return Dynamics(dynamics.number("damping", 0.0), dynamics.number("friction", 0.0))


def _read_mimic(element: UrdfElement) -> Mimic | None:
    mimic = element.child("mimic")
    if mimic is None:
        return None
    return Mimic(
        mimic.needed_text("joint"), mimic.number("multiplier", 1.0), mimic.number("offset", 0.0)
    )


def _read_safety(element: UrdfElement) -> SafetyLimits | None:
    safety = element.child("safety_controller")
    if safety is None:
        return None
    # An attribute must be finite, so -inf can only be the default.
    return SafetyLimits(
        soft_lower=safety.number("soft_lower_limit", -math.inf),
        soft_upper=safety.number("soft_upper_limit", math.inf),
        k_position=safety.number("k_position", 0.0),
        k_velocity=safety.number("k_velocity", 0.0),
    )
