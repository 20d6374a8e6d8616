"""Fewer vertices where nobody sees or feels the difference: hulls to touch, huge meshes to see."""

import math

import numpy as np
from numpy.typing import NDArray

from arm_description.mesh_data import MeshData

Array = NDArray[np.float64]

HULL_DIRECTIONS = 1000
"""The vertices that lie outermost in so many directions make the shape that is touched; on a
sphere of 100 mm its faces lie 0.4 mm inside at most."""
MOST_TRIANGLES = 200_000
"""Of one part of a mesh; what has more is drawn coarser."""
PRODUCTS_AT_ONCE = 4_000_000


def outermost(vertices: Array) -> Array:
    """Return the vertices that bound a mesh from outside, all of them where they are few.

    MuJoCo makes the convex hull; of a hundred thousand vertices that takes it seconds.

    Args:
        vertices: shape (v, 3).
    """
    if len(vertices) <= HULL_DIRECTIONS:
        return vertices
    middle = vertices.mean(axis=0)
    size = np.maximum(np.ptp(vertices, axis=0), np.finfo(np.float64).tiny)
    # Seen in a cube, so that a long thin mesh has its directions where it bends.
    centred = ((vertices - middle) / size).astype(np.float32)
    directions = _directions(HULL_DIRECTIONS).astype(np.float32)
    rows = max(1, PRODUCTS_AT_ONCE // len(vertices))
    found = [
        np.argmax(directions[start : start + rows] @ centred.T, axis=1)
        for start in range(0, len(directions), rows)
    ]
    return vertices[np.unique(np.concatenate(found))]


def simplified(mesh: MeshData, most_triangles: int = MOST_TRIANGLES) -> MeshData:
    """Return a mesh of at most so many triangles: vertices in one cell of a grid become one."""
    cells = math.sqrt(most_triangles)
    while len(mesh.faces) > most_triangles:
        mesh = _clustered(mesh, cells)
        cells *= 0.7
    return mesh


def _clustered(mesh: MeshData, cells: float) -> MeshData:
    low, high = mesh.bounds
    side = float((high - low).max()) / cells
    keys = np.floor((mesh.vertices - low) / side).astype(np.int64)
    _, cluster = np.unique(keys @ (1, 1 << 20, 1 << 40), return_inverse=True)
    cluster = cluster.reshape(-1)
    counts = np.bincount(cluster)
    sums = [np.bincount(cluster, weights=mesh.vertices[:, axis]) for axis in range(3)]
    faces = cluster[mesh.faces]
    kept = (
        (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    )
    return MeshData(
        np.stack(sums, axis=1) / counts[:, None], faces[kept].astype(np.int32), mesh.rgba
    )


def _directions(count: int) -> Array:
    """Return unit vectors spread evenly over the sphere, shape (count, 3), the six axes first."""
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    index = np.arange(count - len(axes)) + 0.5
    height = 1.0 - 2.0 * index / len(index)
    radius = np.sqrt(1.0 - height**2)
    turn = math.pi * (1.0 + math.sqrt(5.0)) * index
    return np.concatenate(
        [axes, np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=1)]
    )
