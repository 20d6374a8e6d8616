"""A part of a robot: its meshes, its mass and its collision shapes."""

import math
from dataclasses import dataclass

from manifold3d import Manifold

from meshes.solid import Vector

ARM_PART_KG = 0.1
"""Mass of every link of the arm that has one, as in the original."""


@dataclass(frozen=True, slots=True)
class Piece:
    """One mesh file of one colour.

    Attributes:
        mesh: name of the file without its ending.
        material: name of a material of the robot's *_materials.xacro.
        solid: the shape, in mm.
    """

    mesh: str
    material: str
    solid: Manifold


@dataclass(frozen=True, slots=True)
class BoxCollision:
    """A box that is the part's collision shape.

    Attributes:
        centre: position of the centre, in mm.
        size: lengths of the edges, in mm.
        rpy: orientation, in rad.
    """

    centre: Vector
    size: Vector
    rpy: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class CylinderCollision:
    """A cylinder that is the part's collision shape.

    Attributes:
        centre: position of the centre, in mm.
        radius: in mm.
        length: along its own axis, in mm.
        rpy: orientation in rad; upright without one.
    """

    centre: Vector
    radius: float
    length: float
    rpy: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Part:
    """The data of one link for the URDF.

    Attributes:
        name: the xacro macro is `part_<name>`.
        pieces: the visuals.
        collisions: the shapes that touch; none for a part that only looks.
        body: the shape that the mass is spread over, in mm; None for a part without mass.
        mass_kg: of the body.
    """

    name: str
    pieces: tuple[Piece, ...]
    collisions: tuple[BoxCollision | CylinderCollision, ...] = ()
    body: Manifold | None = None
    mass_kg: float = ARM_PART_KG


def box_between(lower: Vector, upper: Vector) -> BoxCollision:
    """Return the box between two opposite corners, in mm."""
    centre = tuple((a + b) / 2 for a, b in zip(lower, upper, strict=True))
    size = tuple(b - a for a, b in zip(lower, upper, strict=True))
    return BoxCollision((centre[0], centre[1], centre[2]), (size[0], size[1], size[2]))


def box_around(solid: Manifold) -> BoxCollision:
    """Return the bounding box of a solid."""
    x0, y0, z0, x1, y1, z1 = solid.bounding_box()
    return box_between((x0, y0, z0), (x1, y1, z1))


def beam_between(start: Vector, end: Vector, width: float) -> BoxCollision:
    """Return a square beam between the middles of its ends, in mm; it may lean."""
    way = tuple(b - a for a, b in zip(start, end, strict=True))
    length = math.hypot(*way)
    centre = tuple((a + b) / 2 for a, b in zip(start, end, strict=True))
    # The beam's z axis after roll and pitch: (sin p cos r, -sin r, cos p cos r).
    rpy = (-math.asin(way[1] / length), math.atan2(way[0], way[2]), 0.0)
    return BoxCollision((centre[0], centre[1], centre[2]), (width, width, length), rpy)


def board_between(
    start: tuple[float, float], end: tuple[float, float], thickness: float, width: float
) -> BoxCollision:
    """Return a board that leans, from the line between two points (x, z) in mm to its right.

    Right is as seen from -y, with x to the right and z up. The board reaches `width / 2` to both
    sides of y = 0.
    """
    dx, dz = end[0] - start[0], end[1] - start[1]
    length = math.hypot(dx, dz)
    inward = (dz / length * thickness / 2, -dx / length * thickness / 2)
    centre = ((start[0] + end[0]) / 2 + inward[0], 0.0, (start[1] + end[1]) / 2 + inward[1])
    return BoxCollision(centre, (length, width, thickness), (0.0, -math.atan2(dz, dx), 0.0))
