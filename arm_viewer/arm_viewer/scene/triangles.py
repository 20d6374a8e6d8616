"""Convert the shapes of descriptions to triangles."""

from functools import lru_cache
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray

from arm_description.errors import DescriptionError, MeshFileError
from arm_description.mesh.data import MeshData
from arm_description.mesh.file import check_mesh_file, read_mesh_file
from arm_description.resources import resolve_uri
from arm_description.urdf.robot import Box, Capsule, Cylinder, Geometry, Mesh, Sphere

ROUND_SECTIONS = 40
SPHERE_SUBDIVISIONS = 3
SHARP_RAD = 0.6
"""Faces that meet at a smaller angle form one smooth surface."""
FLAT_RAD = 0.02
"""Faces that meet at a smaller angle have no visible edge between them."""
LARGE_SHARE = 0.1
"""A flat area of at least this fraction of the surface is shaded flat up to its rim."""
MAX_CACHED_FILES = 64


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
    """Return why `triangles` failed in one line, without the searched paths, which are logged."""
    return str(error).partition("\n")[0].removesuffix("; tried:")


def smooth(mesh: MeshData) -> MeshData:
    """Return the mesh with separate vertices on both sides of sharp edges.

    A browser shades smoothly across vertices that faces share. trimesh can do this with SciPy,
    which would double the installed size of this package.
    """
    solid = _mesh(mesh)
    angles, pairs, count = solid.face_adjacency_angles, solid.face_adjacency, len(mesh.faces)
    flat = _patches(count, pairs[angles < FLAT_RAD])
    area = np.bincount(flat, weights=solid.area_faces, minlength=count)
    is_large = (area > LARGE_SHARE * solid.area)[flat]
    joins = (angles < SHARP_RAD) & ~is_large[pairs].any(axis=1)
    patch = np.where(is_large, flat, _patches(count, pairs[joins]))
    corners = patch[:, None] * len(mesh.vertices) + mesh.faces
    kept, faces = np.unique(corners, return_inverse=True)
    vertices = mesh.vertices[kept % len(mesh.vertices)]
    return MeshData(vertices, faces.reshape(-1, 3).astype(np.int32), mesh.rgba)


def edges(mesh: MeshData) -> NDArray[np.float32]:
    """Return the edges (n, 2, 3) between faces that meet at an angle, and boundary edges."""
    solid = _mesh(mesh)
    solid.merge_vertices()
    bent = solid.face_adjacency_edges[solid.face_adjacency_angles > FLAT_RAD]
    alone = solid.edges_sorted[trimesh.grouping.group_rows(solid.edges_sorted, require_count=1)]
    return solid.vertices[np.concatenate([bent, alone])].astype(np.float32)


@lru_cache(maxsize=MAX_CACHED_FILES)
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


def _patches(count: int, pairs: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the lowest index among the faces connected to each face by pairs, shape (count,)."""
    lowest = np.arange(count)
    while True:
        joined = lowest.copy()
        of_pairs = lowest[pairs]
        np.minimum.at(joined, of_pairs, of_pairs.min(axis=1, keepdims=True))
        while not np.array_equal(joined, further := joined[joined]):
            joined = further
        if np.array_equal(joined, lowest):
            return lowest
        lowest = joined
