"""The files of the parts: a mesh for every piece, a xacro macro for every part."""

from pathlib import Path

import numpy as np
import trimesh
from manifold3d import Manifold
from trimesh.exchange.stl import export_stl

from meshes.part import BoxCollision, CylinderCollision, Part, Piece
from meshes.solid import Vector

MM = 1e-3
SLIVER_MM = 1e-3
"""Thinner triangles are removed, because an STL's 32-bit numbers would leave gaps."""

HEADER = """\
<?xml version="1.0"?>
<!--
  Visuals, masses and collision shapes of the parts. Written by tools/make_meshes.py from the same
  shapes as the meshes: change them there, not here.

  {masses}, spread evenly over its shape; so its centre of mass is the shape's, and not
  the link's origin as in the original.
-->
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
"""


def write_mesh(piece: Piece, folder: Path) -> Path:
    """Write one piece as a binary STL in metres and return its path."""
    path = folder / f"{piece.mesh}.stl"
    path.write_bytes(export_stl(to_trimesh(piece.solid)))
    return path


def write_macros(parts: tuple[Part, ...], path: Path, meshes: str, masses: str) -> None:
    """Write one xacro macro for each part: the content of a link.

    Args:
        parts: what to write.
        path: the xacro file.
        meshes: the package and the folder in it that holds the parts' meshes.
        masses: how the header's sentence on the masses begins.
    """
    header = HEADER.replace("{masses}", masses)
    macros = "\n".join(_macro(part, meshes) for part in parts)
    path.write_text(f"{header}{macros}</robot>\n", encoding="utf-8")


def to_trimesh(solid: Manifold) -> trimesh.Trimesh:
    """Return a solid in mm as a mesh in metres."""
    mesh = solid.simplify(SLIVER_MM).to_mesh()
    vertices = np.asarray(mesh.vert_properties, dtype=np.float64)[:, :3] * MM
    return trimesh.Trimesh(vertices, np.asarray(mesh.tri_verts), process=False)


def _macro(part: Part, meshes: str) -> str:
    blocks = [] if part.body is None else [_inertial(part.body, part.mass_kg)]
    blocks += [_visual(piece, meshes) for piece in part.pieces]
    blocks += [_collision(collision) for collision in part.collisions]
    return f'  <xacro:macro name="part_{part.name}">\n{"".join(blocks)}  </xacro:macro>\n'


def _inertial(body: Manifold, mass_kg: float) -> str:
    mesh = to_trimesh(body)
    mesh.density = mass_kg / mesh.volume
    tensor = mesh.moment_inertia
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    values = tensor[np.triu_indices(3)]
    noise = 1e-6 * float(np.trace(tensor))
    shown = [0.0 if abs(value) < noise else value for value in values]
    inertia = " ".join(f'{n}="{v:.4g}"' for n, v in zip(names, shown, strict=True))
    centre = mesh.center_mass / MM
    return (
        "    <inertial>\n"
        f"      {_origin((centre[0], centre[1], centre[2]))}\n"
        f'      <mass value="{mass_kg:g}"/>\n'
        f"      <inertia {inertia}/>\n"
        "    </inertial>\n"
    )


def _visual(piece: Piece, meshes: str) -> str:
    uri = f"package://{meshes}/{piece.mesh}.stl"
    return (
        "    <visual>\n"
        f'      <geometry><mesh filename="{uri}"/></geometry>\n'
        f'      <material name="{piece.material}"/>\n'
        "    </visual>\n"
    )


def _collision(collision: BoxCollision | CylinderCollision) -> str:
    if isinstance(collision, BoxCollision):
        shape = f'<box size="{_metres(collision.size)}"/>'
    else:
        length, radius = _metres((collision.length,)), _metres((collision.radius,))
        shape = f'<cylinder radius="{radius}" length="{length}"/>'
    return (
        "    <collision>\n"
        f"      {_origin(collision.centre, collision.rpy)}\n"
        f"      <geometry>{shape}</geometry>\n"
        "    </collision>\n"
    )


def _origin(centre: Vector, rpy: Vector = (0.0, 0.0, 0.0)) -> str:
    turn = " ".join(f"{angle:.5g}" for angle in rpy)
    return f'<origin xyz="{_metres(centre)}" rpy="{turn}"/>'


def _metres(lengths_mm: tuple[float, ...]) -> str:
    """Return lengths in metres to the hundredth of a millimetre."""
    return " ".join(f"{round(length * MM, 5) + 0.0:g}" for length in lengths_mm)
