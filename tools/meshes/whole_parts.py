"""One mesh for a whole part: in its colours as COLLADA, and of its collision shapes as STL."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path

import trimesh
from trimesh.exchange.dae import export_collada
from trimesh.exchange.stl import export_stl
from trimesh.transformations import euler_matrix, translation_matrix
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from meshes.part import BoxCollision, CylinderCollision, Part
from meshes.part_files import MM, to_trimesh

DIGITS = 6
"""Digits of a coordinate in metres behind the point: a micrometre."""
WRITTEN_AT = re.compile(rb"<(created|modified)>[^<]*<")
SOME_TIME = rb"<\1>2000-01-01T00:00:00<"
DRAWN_ID = re.compile(rb"[0-9a-f]{32}")


def read_colours(materials: Path) -> dict[str, tuple[float, ...]]:
    """Return the colours of a xacro file of materials: red, green, blue, alpha, by name."""
    found = ET.parse(materials).getroot().iter("material")
    colours = {str(material.get("name")): material.find("color") for material in found}
    return {
        name: tuple(float(word) for word in str(colour.get("rgba")).split())
        for name, colour in colours.items()
        if colour is not None
    }


def write_coloured_mesh(part: Part, colours: Mapping[str, tuple[float, ...]], folder: Path) -> Path:
    """Write all pieces of a part to one COLLADA file, in metres, and return its path."""
    pieces: list[trimesh.Trimesh] = []
    for piece in part.pieces:
        mesh = to_trimesh(piece.solid)
        mesh.vertices = mesh.vertices.round(DIGITS)
        material = PBRMaterial(name=piece.material, baseColorFactor=colours[piece.material])
        mesh.visual = TextureVisuals(material=material)
        pieces.append(mesh)
    path = folder / f"{part.name}.dae"
    path.write_bytes(_repeatable(export_collada(pieces)))
    return path


def _repeatable(collada: bytes) -> bytes:
    """Return a COLLADA file with z up, and the same for the same shapes.

    trimesh says y, and writes the time and ids drawn by chance.
    """
    ids = dict.fromkeys(DRAWN_ID.findall(collada))
    for number, drawn in enumerate(ids):
        collada = collada.replace(drawn, f"colour{number}".encode())
    return WRITTEN_AT.sub(SOME_TIME, collada.replace(b">Y_UP<", b">Z_UP<"))


def write_collision_mesh(part: Part, folder: Path) -> Path:
    """Write the collision shapes of a part to one STL file, in metres, and return its path."""
    path = folder / f"{part.name}.stl"
    shapes = [_shape(collision) for collision in part.collisions]
    path.write_bytes(export_stl(trimesh.util.concatenate(shapes)))
    return path


def _shape(collision: BoxCollision | CylinderCollision) -> trimesh.Trimesh:
    centre = translation_matrix([length * MM for length in collision.centre])
    pose = centre @ euler_matrix(*collision.rpy)
    if isinstance(collision, BoxCollision):
        return trimesh.creation.box([edge * MM for edge in collision.size], pose)
    radius, length = collision.radius * MM, collision.length * MM
    return trimesh.creation.cylinder(radius, length, sections=32, transform=pose)
