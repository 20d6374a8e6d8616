"""The shapes of descriptions as triangles."""

from functools import lru_cache
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray

from arm_description.errors import DescriptionError, MeshFileError
from arm_description.mesh_data import MeshData
from arm_description.mesh_file import check_mesh_file, read_mesh_file
from arm_description.resources import resolve_uri
from arm_description.robot import Box, Capsule, Cylinder, Geometry, Mesh, Sphere

ROUND_SECTIONS = 40
SPHERE_SUBDIVISIONS = 3
SHARP_RAD = 0.6
"""Faces that meet at less make one smooth surface."""
FLAT_RAD = 0.02
"""Faces that meet at less have no edge between them."""
MOST_FILES = 64


def triangles(geometry: Geometry) -> tuple[MeshData, ...]:
    """Return a shape's parts in its own frame, one for each colour of a mesh file.

    Raises:
        DescriptionError: a mesh cannot be found or read; the message names it.
    """
    if isinstance(geometry, Mesh):
        return tuple(part.scaled(geometry.scale) for part in _read(resolve_uri(geometry.uri)))
    solid = _solid(geometry)
    return (MeshData(np.asarray(solid.vertices), np.asarray(solid.faces, dtype=np.int32)),)


def problem_of(error: DescriptionError) -> str:
    """Return in one line why `triangles` failed; where a file was looked for is for the log."""
    return str(error).partition("\n")[0].removesuffix("; tried:")


def smooth(mesh: MeshData) -> MeshData:
    """Return the mesh with vertices of their own on both sides of sharp edges.

    A browser shades over a vertex that several faces share.
    """
    return _data(trimesh.graph.smooth_shade(_mesh(mesh), angle=SHARP_RAD), mesh)


def edges(mesh: MeshData) -> NDArray[np.float32]:
    """Return the lines (n, 2, 3) where faces meet at an angle, and those with one face only."""
    solid = _mesh(mesh)
    solid.merge_vertices()
    bent = solid.face_adjacency_edges[solid.face_adjacency_angles > FLAT_RAD]
    alone = solid.edges_sorted[trimesh.grouping.group_rows(solid.edges_sorted, require_count=1)]
    return solid.vertices[np.concatenate([bent, alone])].astype(np.float32)


@lru_cache(maxsize=MOST_FILES)
def _read(path: Path) -> tuple[MeshData, ...]:
    try:
        check_mesh_file(path)
        parts = read_mesh_file(path)
        for part in parts:
            part.check()
    except (MeshFileError, OSError) as error:
        raise MeshFileError(f"cannot use the mesh {path}: {error}") from error
    return parts


def _solid(geometry: Box | Cylinder | Sphere | Capsule) -> trimesh.Trimesh:
    creation = trimesh.creation
    match geometry:
        case Box(size):
            return creation.box(extents=size)
        case Cylinder(radius, length):
            return creation.cylinder(radius=radius, height=length, sections=ROUND_SECTIONS)
        case Sphere(radius):
            return creation.icosphere(subdivisions=SPHERE_SUBDIVISIONS, radius=radius)
        case Capsule(radius, length):
            count = [ROUND_SECTIONS, ROUND_SECTIONS // 2]
            return creation.capsule(height=length, radius=radius, count=count)


def _mesh(data: MeshData) -> trimesh.Trimesh:
    return trimesh.Trimesh(data.vertices, data.faces, process=False)


def _data(mesh: trimesh.Trimesh, like: MeshData) -> MeshData:
    return MeshData(np.asarray(mesh.vertices), np.asarray(mesh.faces, dtype=np.int32), like.rgba)
