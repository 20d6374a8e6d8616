"""A path through way points whose corners are rounded by circular arcs.

The idea is Kunz and Stilman's (Time-Optimal Trajectory Generation for Path Following with Bounded
Acceleration and Velocity, RSS 2012, section IV): each corner is replaced by the circle that touches
both of its sides, as large as the tolerance and half of each side allow.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

STRAIGHT = 1e-6
"""Corners of less than this many rad count as straight."""
REVERSAL = np.pi - 1e-3
"""Corners of more than this many rad count as a reversal, at which the motion stops."""


@dataclass(frozen=True, slots=True, eq=False)
class RoundedPath:
    """Straight pieces and circular arcs in joint space, joined without a kink.

    An arc bends from its direction towards its normal; a straight piece has curvature 0.

    Attributes:
        starts: where each piece begins, (k, n).
        directions: unit tangent at its start, (k, n).
        normals: unit vector towards the centre, (k, n).
        curvatures: 1 / radius, (k,).
        lengths: arc length, (k,).
    """

    starts: Array
    directions: Array
    normals: Array
    curvatures: Array
    lengths: Array

    def positions(self, piece: Indices, along: Array) -> Array:
        """Return the states at some distances from the starts of some pieces, (..., n)."""
        angle = along * self.curvatures[piece]
        # sin(a) / a and its like need no special case for straight pieces.
        sine, half = _sinc(angle), 0.5 * angle
        aside = along * np.sin(half) * _sinc(half)
        return (
            self.starts[piece]
            + (along * sine)[..., None] * self.directions[piece]
            + aside[..., None] * self.normals[piece]
        )

    def tangents(self, piece: Indices, along: Array) -> Array:
        """Return the first derivative by arc length, (..., n)."""
        angle = (along * self.curvatures[piece])[..., None]
        return np.cos(angle) * self.directions[piece] + np.sin(angle) * self.normals[piece]

    def bends(self, piece: Indices, along: Array) -> Array:
        """Return the second derivative by arc length, (..., n)."""
        curvature = self.curvatures[piece]
        angle = (along * curvature)[..., None]
        turned = np.cos(angle) * self.normals[piece] - np.sin(angle) * self.directions[piece]
        return curvature[..., None] * turned


def rounded_paths(points: Array, tolerances: Array) -> list[RoundedPath]:
    """Return the paths from stop to stop.

    Args:
        points: way points, no two in a row equal, (m, n), m >= 2.
        tolerances: how far the path may pass by each way point, (m,); where it is 0, the motion
            stops unless the path is straight there. The first and the last do not matter.
    """
    sides = np.diff(points, axis=0)
    lengths = np.linalg.norm(sides, axis=1)
    directions = sides / lengths[:, None]
    before, after = directions[:-1], directions[1:]
    angles = 2.0 * np.arctan2(
        np.linalg.norm(after - before, axis=1), np.linalg.norm(after + before, axis=1)
    )
    is_corner = angles > STRAIGHT
    is_stop = is_corner & ((angles > REVERSAL) | (tolerances[1:-1] <= 0.0))
    is_arc = is_corner & ~is_stop
    safe = np.where(is_arc, angles, 1.0)
    # The circle passes the corner at a distance of cut * tan(angle / 4).
    cuts = np.where(
        is_arc,
        np.minimum(
            0.5 * np.minimum(lengths[:-1], lengths[1:]), tolerances[1:-1] / np.tan(safe / 4.0)
        ),
        0.0,
    )
    bend = after - np.cos(safe)[:, None] * before
    whole = _interleaved(points, directions, lengths, cuts, bend / np.sin(safe)[:, None], safe)
    splits = np.flatnonzero(is_stop) + 1
    return [_part(whole, *ends) for ends in _runs(splits, len(lengths))]


def _interleaved(
    points: Array, directions: Array, lengths: Array, cuts: Array, normals: Array, angles: Array
) -> RoundedPath:
    """Return line, arc, line, arc, ..., line; what does not exist has length 0."""
    count = len(lengths)
    into, out = np.append(cuts, 0.0), np.insert(cuts, 0, 0.0)
    starts = np.empty((2 * count - 1, points.shape[1]))
    starts[::2] = points[:-1] + out[:, None] * directions
    starts[1::2] = points[1:-1] - cuts[:, None] * directions[:-1]
    headings = np.empty_like(starts)
    headings[::2], headings[1::2] = directions, directions[:-1]
    towards = np.zeros_like(starts)
    towards[1::2] = np.where(cuts[:, None] > 0.0, normals, 0.0)
    curvatures, extents = np.zeros(2 * count - 1), np.zeros(2 * count - 1)
    extents[::2] = lengths - into - out
    radii = cuts / np.tan(angles / 2.0)
    curvatures[1::2] = np.divide(1.0, radii, out=np.zeros_like(radii), where=radii > 0.0)
    extents[1::2] = radii * angles
    return RoundedPath(starts, headings, towards, curvatures, extents)


def _runs(splits: Indices, count: int) -> list[tuple[int, int]]:
    """Return the first and last side of each run between stops."""
    firsts = [0, *splits.tolist()]
    return list(zip(firsts, [*firsts[1:], count], strict=True))


def _part(whole: RoundedPath, first: int, end: int) -> RoundedPath:
    """Return the pieces of some sides, without those of no length."""
    every = slice(2 * first, 2 * end - 1)
    # What rounding leaves of a side between two arcs is not a piece.
    exists = whole.lengths[every] > 1e-12 * max(1.0, float(whole.lengths[every].max()))
    return RoundedPath(
        whole.starts[every][exists],
        whole.directions[every][exists],
        whole.normals[every][exists],
        whole.curvatures[every][exists],
        whole.lengths[every][exists],
    )


def _sinc(angle: Array) -> Array:
    return np.sinc(angle / np.pi)
