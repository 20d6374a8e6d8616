"""URDF's <link>: inertia, shapes and materials."""

from collections.abc import Mapping

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

Materials = Mapping[str, Material]
"""Materials that are defined, so have a colour or a texture, by name."""


def read_link(element: UrdfElement, materials: Materials) -> Link:
    """Read a <link>; a visual that only names a material gets it from `materials`.

    Raises:
        UrdfError: naming element and line.
    """
    name = element.needed_text("name")
    element = element.named(name)
    inertial = element.child("inertial")
    return Link(
        name=name,
        inertial=None if inertial is None else _read_inertial(inertial),
        visuals=tuple(_read_visual(visual, materials) for visual in element.children("visual")),
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


def defined_materials(robot: UrdfElement) -> dict[str, Material]:
    """Return the named materials that a <robot> defines, the global ones before the links'."""
    elements = list(robot.children("material"))
    for link in robot.children("link"):
        for visual in link.named(link.needed_text("name")).children("visual"):
            elements.extend(visual.children("material"))
    defined: dict[str, Material] = {}
    for element in elements:
        material = read_material(element)
        if material.name and (material.rgba is not None or material.texture is not None):
            defined.setdefault(material.name, material)
    return defined


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


def _read_visual(element: UrdfElement, materials: Materials) -> Visual:
    material = element.child("material")
    return Visual(
        name=element.text("name", ""),
        origin=element.origin(),
        geometry=_read_geometry(element),
        material=None if material is None else _resolve(read_material(material), materials),
    )


def _resolve(material: Material, materials: Materials) -> Material:
    if material.rgba is not None or material.texture is not None:
        return material
    return materials.get(material.name, material)


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
