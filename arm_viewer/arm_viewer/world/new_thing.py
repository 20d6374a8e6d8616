"""A thing that the user adds to the world, as SDF: from fields of the page, or around a mesh."""

import math
import re
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import quoteattr

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_viewer.world.shape_fields import ObjectKind, read_pose, read_shape

NAME = re.compile(r"[A-Za-z0-9_.\-]{1,100}", re.ASCII)
"""What the simulation accepts as the name of an entity."""
MESH_RGB = (0.62, 0.66, 0.71)
MESH_MASS_KG, MESH_FRICTION = 0.1, 1.0


@dataclass(frozen=True, slots=True)
class ThingFields:
    """What the user has entered, as it is.

    Attributes:
        name: name of the thing.
        kind: its shape.
        size: the lengths of its kind, in m.
        position: of its centre in the world, x y z in m.
        rpy: roll, pitch and yaw, in rad.
        rgb: colour, each component 0 to 255.
        mass: in kg.
        friction: coefficient of friction.
        is_fixed: whether it stays where it is.
    """

    name: str
    kind: ObjectKind
    size: str
    position: str
    rpy: str
    rgb: tuple[int, int, int]
    mass: float
    friction: float
    is_fixed: bool


def new_thing(fields: ThingFields) -> tuple[str, RigidTransform]:
    """Return the SDF of the thing, and its pose in the world.

    Raises:
        ValueError: a field cannot be used; the message is a sentence.
    """
    if not NAME.fullmatch(fields.name):
        raise ValueError(
            f"'{fields.name}' is not a name; it takes 1 to 100 letters, digits and _ . -"
        )
    pose = read_pose(fields.position, fields.rpy)
    if not (math.isfinite(fields.mass) and fields.mass > 0.0):
        raise ValueError(f"The mass must be greater than 0 kg, not {fields.mass:g} kg.")
    if not (math.isfinite(fields.friction) and fields.friction >= 0.0):
        raise ValueError(f"The friction must be at least 0, not {fields.friction:g}.")
    red, green, blue = (component / 255.0 for component in fields.rgb)
    shape = _shape_element(read_shape(fields.kind, fields.size))
    return _sdf(
        fields.name, shape, (red, green, blue), fields.mass, fields.friction, fields.is_fixed
    ), pose


def mesh_thing(name: str, mesh: Path, metres: float) -> str:
    """Return the SDF of a free thing with the shape of a mesh file in a unit of so many metres."""
    uri = mesh.as_uri()
    shape = f"<mesh><uri>{uri}</uri><scale>{metres} {metres} {metres}</scale></mesh>"
    return _sdf(name, shape, MESH_RGB, MESH_MASS_KG, MESH_FRICTION, False)


def _shape_element(shape: Box | Sphere | Cylinder) -> str:
    match shape:
        case Box(size):
            return f"<box><size>{' '.join(map(repr, size))}</size></box>"
        case Sphere(radius):
            return f"<sphere><radius>{radius}</radius></sphere>"
        case Cylinder(radius, length):
            return f"<cylinder><radius>{radius}</radius><length>{length}</length></cylinder>"


def _sdf(
    name: str,
    shape: str,
    rgb: tuple[float, float, float],
    mass: float,
    friction: float,
    is_fixed: bool,
) -> str:
    colour = " ".join(f"{component:.3g}" for component in (*rgb, 1.0))
    return f"""<sdf version="1.11"><model name={quoteattr(name)}>
<static>{str(is_fixed).lower()}</static>
<link name="link"><inertial auto="true"><mass>{mass}</mass></inertial>
<visual name="visual"><geometry>{shape}</geometry>
<material><ambient>{colour}</ambient><diffuse>{colour}</diffuse></material></visual>
<collision name="collision"><geometry>{shape}</geometry>
<surface><friction><ode><mu>{friction}</mu></ode></friction></surface>
</collision></link></model></sdf>"""
