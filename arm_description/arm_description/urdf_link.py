"""URDF's <link>: inertia, shapes and materials."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from arm_description.robot import (
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
from arm_description.urdf_element import UrdfElement


def read_link(element: UrdfElement) -> Link:
    """Read a <link>; a visual that only names a material has only its name.

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
    """Read a <material>; without colour and texture it is only a name.

    Raises:
        UrdfError: a colour that is not four numbers, a texture without a file.
    """
    color = element.child("color")
    texture = element.child("texture")
    rgba = None
    if color is not None:
        values = color.numbers("rgba", 4)
        red, green, blue, alpha = (min(max(value, 0.0), 1.0) for value in values)
        rgba = (red, green, blue, alpha)
        if rgba != values:
            color.warn(f"has rgba='{color.text('rgba', '')}'; values are brought to 0 to 1")
    return Material(
        name=element.text("name", ""),
        rgba=rgba,
        texture=None if texture is None else texture.needed_text("filename"),
    )


def resolve_materials(links: Sequence[Link], materials: Iterable[Material]) -> tuple[Link, ...]:
    """Give the visuals that only name a material what is defined under this name.

    Args:
        links: as read.
        materials: those of the whole robot; they go before what a link's visual defines, and
            among those the first goes before the others.
    """
    used = (visual.material for link in links for visual in link.visuals)
    defined: dict[str, Material] = {}
    for material in [*materials, *used]:
        # A name of nothing stands for nothing: no colour is carried over to the next visual.
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
    shapes = [(shape, read) for tag, read in _SHAPES.items() for shape in geometry.children(tag)]
    if len(shapes) != 1:
        raise geometry.error(f"has {len(shapes)} shapes; it takes one of {', '.join(_SHAPES)}")
    shape, read = shapes[0]
    return read(shape)


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
