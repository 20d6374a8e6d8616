"""Cuts the polygons of a mesh into triangles, those with notches, too.

A fan from one corner, which mesh libraries draw, covers the notch of an L and overlaps itself.
"""

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Indices = NDArray[np.int64]

STRAIGHT = 1e-9
"""A corner that turns by less, as a share of the polygon's area, is on a straight line."""


def triangulated(points: Points, corners: Indices, counts: Indices) -> tuple[Indices, Indices]:
    """Return the triangles of polygons, and the number of the polygon of each.

    Args:
        points: shape (p, 3).
        corners: indices of points of all polygons, one after the other, shape (sum(counts),).
        counts: number of corners of each polygon; those with less than 3 are left out.

    Returns:
        Triangles, shape (t, 3), turning as their polygons do, and polygons, shape (t,), ascending.
    """
    starts = np.cumsum(counts) - counts
    triangles: list[Indices] = [np.empty((0, 3), np.int64)]
    owners: list[Indices] = [np.empty(0, np.int64)]
    for count in np.unique(counts[counts >= 3]).tolist():
        those = np.flatnonzero(counts == count)
        rows = corners[starts[those, None] + np.arange(count)]
        fan = np.array([(0, k, k + 1) for k in range(1, count - 1)])
        cut = rows[:, fan]
        if count > 3:
            for index in np.flatnonzero(~_convex(points[rows])).tolist():
                cut[index] = rows[index][np.array(list(_ears(points[rows[index]])))]
        triangles.append(cut.reshape(-1, 3))
        owners.append(np.repeat(those, count - 2))
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    return np.concatenate(triangles)[order], owner[order]


def notched(points: Points, polygons: Iterable[Indices]) -> bool:
    """Return whether any polygon, given by the indices of its points, has a notch."""
    return any(len(corners) > 3 and not _convex(points[corners][None])[0] for corners in polygons)


def _convex(polygons: Points) -> NDArray[np.bool_]:
    """Return which polygons, shape (f, n, 3), have no corner that turns inwards."""
    sides = np.roll(polygons, -1, axis=1) - polygons
    turns = np.cross(np.roll(sides, 1, axis=1), sides)
    normals = _normals(polygons)
    bends = np.einsum("fnk,fk->fn", turns, normals)
    least = -STRAIGHT * np.einsum("fk,fk->f", normals, normals)
    return (bends >= least[:, None]).all(axis=1)


def _normals(polygons: Points) -> Points:
    """Return the normals, twice as long as the polygons' areas, by Newell's method: (f, 3)."""
    about = polygons - polygons[:, :1]
    return np.cross(about, np.roll(about, -1, axis=1)).sum(axis=1)


def _ears(polygon: Points) -> Iterator[tuple[int, int, int]]:
    """Yield n - 2 triangles of a polygon, shape (n, 3), by cutting off its ears."""
    flat = _in_its_plane(polygon)
    left = list(range(len(flat)))
    at, refused = 0, 0
    while len(left) > 3:
        at %= len(left)
        one, two, three = left[at - 1], left[at], left[(at + 1) % len(left)]
        # A polygon that crosses itself may have no ear left; then any corner will do.
        if refused > len(left) or _is_ear(flat, left, (one, two, three)):
            yield one, two, three
            del left[at]
            # The corner after next: ears from all around give better triangles than a fan.
            refused = 0
        else:
            refused += 1
        at += 1
    yield left[0], left[1], left[2]


def _in_its_plane(polygon: Points) -> Points:
    """Return the corners in the polygon's plane, counter-clockwise, shape (n, 2)."""
    normal = _normals(polygon[None])[0]
    axis = int(np.argmax(np.abs(normal)))
    first, second = ((1, 2), (2, 0), (0, 1))[axis]
    if normal[axis] < 0.0:
        first, second = second, first
    return polygon[:, (first, second)]


def _is_ear(flat: Points, left: list[int], ear: tuple[int, int, int]) -> bool:
    """Return whether a corner can be cut off: it turns outwards, and no other corner is in it."""
    one, two, three = flat[list(ear)]
    if _turn(one, two, three) <= 0.0:
        return False
    others = flat[[index for index in left if index not in ear]]
    # Where the outline touches itself, corners have the same place.
    others = others[~(others[:, None] == flat[list(ear)]).all(axis=2).any(axis=1)]
    inside = _turn(one, two, others) >= 0.0
    inside &= _turn(two, three, others) >= 0.0
    inside &= _turn(three, one, others) >= 0.0
    return not inside.any()


def _turn(one: Points, two: Points, three: Points) -> Points:
    """Return twice the area of triangles, above 0 for those that turn counter-clockwise."""
    along, across = two - one, three - one
    return along[0] * across[..., 1] - along[1] * across[..., 0]
