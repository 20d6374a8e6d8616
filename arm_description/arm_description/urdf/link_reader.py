"""Reads URDF's <link>: inertia, shapes and materials."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from arm_description.urdf.element import UrdfElement
from arm_description.urdf.robot import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    Link,
    Material,
    Mesh,
    Sphere,
    Visual,
)


def read_link(element: UrdfElement) -> Link:
    """Read a <link>; a material that is only named has only a name.

    Raises:
        UrdfError: naming element and line.
    """
    name = element.needed_text("name")
    element = element.named(name)
    inertial = element.child("inertial")
    return Link(
        name=name,
        inertial=None if inertial is None else _read_inertial(inertial),
        visuals=tuple(_read_visual(visual) for visual in element.children("visual")),
        collisions=tuple(_read_collision(shape) for shape in element.children("collision")),
        line=element.line,
    )


def read_material(element: UrdfElement) -> Material:
    """Read a <material>; without colour and texture it has only a name.

    Raises:
        UrdfError: a colour is not four numbers, or a texture has no file.
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
    return Material(
        name=element.text("name", ""),
        rgba=rgba,
        texture=None if texture is None else texture.needed_text("filename"),
    )


def resolve_materials(links: Sequence[Link], materials: Iterable[Material]) -> tuple[Link, ...]:
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
        material=None if material is None else read_material(material),
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
