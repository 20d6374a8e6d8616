"""Reduce vertices where the difference does not matter: collision hulls and huge visual meshes."""

import math

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import MeshFileError
from arm_description.mesh.data import MeshData

Array = NDArray[np.float64]

HULL_DIRECTIONS = 1000
"""The collision hull consists of the outermost vertices in this many directions. On a sphere of
100 mm its faces lie at most 0.4 mm inside."""
MAX_TRIANGLES = 200_000
"""Limit on the triangles of one part of a mesh; larger parts are simplified."""
CELL_REDUCTION = 0.7
MIN_CELLS = 40.0
"""Fewest grid cells along a mesh; with fewer the mesh is unrecognisable."""
SAMPLE = 50_000
SAMPLING_ERROR = 1.05
MANY_VERTICES = 200_000
GRID = 64
PRODUCTS_AT_ONCE = 4_000_000


def outermost(vertices: Array) -> Array:
    """Return the outermost of a mesh's vertices, shape (v, 3); all of them if they are few.

    MuJoCo computes the convex hull, which takes seconds for a hundred thousand vertices.
    """
    if len(vertices) <= HULL_DIRECTIONS:
        return vertices
    middle = vertices.mean(axis=0)
    size = np.maximum(np.ptp(vertices, axis=0), np.finfo(np.float64).tiny)
    # Scaled to a cube, so that the directions also resolve a long thin mesh.
    centred = ((vertices - middle) / size).astype(np.float32)
    directions = _directions(HULL_DIRECTIONS).astype(np.float32)
    if len(vertices) > MANY_VERTICES:
        return vertices[np.unique(_farthest_by_cell(centred, directions))]
    rows = max(1, PRODUCTS_AT_ONCE // len(vertices))
    found = [
        np.argmax(directions[start : start + rows] @ centred.T, axis=1)
        for start in range(0, len(directions), rows)
    ]
    return vertices[np.unique(np.concatenate(found))]


def simplified(mesh: MeshData, most_triangles: int = MAX_TRIANGLES) -> MeshData:
    """Return a mesh of at most `most_triangles`: the vertices in one cell of a grid are merged."""
    cells = math.sqrt(most_triangles)
    while len(mesh.faces) > most_triangles:
        cells = _finest_grid(mesh, cells, most_triangles)
        mesh = _clustered(mesh, cells)
        cells *= CELL_REDUCTION
    return mesh


def _finest_grid(mesh: MeshData, cells: float, most_triangles: int) -> float:
    """Return the finest grid that leaves few enough triangles, judged by a sample.

    Raises:
        MeshFileError: every such grid is too coarse to show the mesh.
    """
    step = -(-len(mesh.faces) // SAMPLE)
    low, high = mesh.bounds
    corners = mesh.vertices[mesh.faces[::step].ravel()] - low
    while cells >= MIN_CELLS:
        keys = _cells(corners, float((high - low).max()) / cells).reshape(-1, 3)
        if np.count_nonzero(_spans_three(keys)) * step <= most_triangles * SAMPLING_ERROR:
            return cells
        cells *= CELL_REDUCTION
    raise MeshFileError(
        f"its {len(mesh.faces)} triangles cannot be reduced to the {most_triangles} that one part "
        "may have: they are large and do not share corners; reduce them in a mesh editor"
    )


def _cells(points: Array, side: float) -> NDArray[np.int64]:
    """Return a number for the cell of each point; coordinates must not be negative."""
    x, y, z = (np.floor(points[:, axis] / side).astype(np.int64) for axis in range(3))
    return x + (y << 20) + (z << 40)


def _spans_three(faces: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return which triangles have their corners in three different cells."""
    first, second, third = faces.T
    return (first != second) & (second != third) & (third != first)


def _clustered(mesh: MeshData, cells: float) -> MeshData:
    low, high = mesh.bounds
    side = float((high - low).max()) / cells
    _, cluster = np.unique(_cells(mesh.vertices - low, side), return_inverse=True)
    cluster = cluster.reshape(-1)
    counts = np.bincount(cluster)
    sums = [np.bincount(cluster, weights=mesh.vertices[:, axis]) for axis in range(3)]
    faces = cluster[mesh.faces]
    kept = faces[_spans_three(faces)].astype(np.int32)
    return MeshData(np.stack(sums, axis=1) / counts[:, None], kept, mesh.rgba)


def _farthest_by_cell(
    points: NDArray[np.float32], directions: NDArray[np.float32]
) -> NDArray[np.intp]:
    """Return the index of the farthest point in each direction; points are in a unit cube.

    It searches only the grid cells that reach far enough, about one point in a hundred.
    """
    low = points.min(axis=0)
    cells = np.minimum(((points - low) * GRID).astype(np.int8), GRID - 1)
    order = np.flatnonzero(_outside(cells)[tuple(cells.T)])
    numbers = cells[order].astype(np.int64) @ (GRID * GRID, GRID, 1)
    order = order[np.argsort(numbers)]
    occupied, counts = np.unique(numbers, return_counts=True)
    starts = np.cumsum(counts) - counts
    sorted_points = points[order]
    places = np.stack(np.unravel_index(occupied, (GRID, GRID, GRID)), axis=1)
    centres = ((places + 0.5) / GRID + low).astype(np.float32)
    found = np.empty(len(directions), np.intp)
    for number, direction in enumerate(directions):
        reach = centres @ direction
        # Half a cell of slack for the farthest cell and half a cell for any other.
        slack = float(np.abs(direction).sum()) / GRID * 1.001
        chosen = np.flatnonzero(reach >= reach.max() - slack)
        rows = _ranges(starts[chosen], counts[chosen])
        found[number] = order[rows[np.argmax(sorted_points[rows] @ direction)]]
    return found


def _outside(cells: NDArray[np.int8]) -> NDArray[np.bool_]:
    """Return which cells can hold the farthest point in some direction, shape (GRID,) * 3.

    Such a cell is near an end of its row along the dominant axis of the direction: a point three
    whole cells farther along that axis is always farther.
    """
    occupied = np.zeros((GRID, GRID, GRID), bool)
    occupied[tuple(cells.T)] = True
    outside = np.zeros_like(occupied)
    places = np.arange(GRID)
    for axis in range(3):
        rows = np.moveaxis(occupied, axis, 2)
        first = rows.argmax(axis=2)[..., None]
        last = GRID - 1 - rows[..., ::-1].argmax(axis=2)[..., None]
        ends = (places <= first + 3) | (places >= last - 3)
        outside |= np.moveaxis(rows & ends, 2, axis)
    return outside


def _ranges(starts: NDArray[np.intp], counts: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return the concatenated ranges that begin at `starts` and have lengths `counts`."""
    ends = np.cumsum(counts)
    return np.arange(ends[-1]) + np.repeat(starts - (ends - counts), counts)


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
