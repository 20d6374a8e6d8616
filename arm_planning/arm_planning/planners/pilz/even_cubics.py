"""Cubics through points at equal steps (Hermite)."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def even_cubics(points: Array, slopes: Array, shares: Array) -> Array:
    """Return the values of cubics that meet points with given slopes, (k, n).

    Args:
        points: (m, n), at equal steps of the share from 0 to 1.
        slopes: change per step at each point, (m, n).
        shares: where, (k,), 0 to 1.
    """
    count = len(points) - 1
    index = np.clip((shares * count).astype(np.intp), 0, count - 1)
    t = (shares * count - index)[:, None]
    p0, p1, v0, v1 = points[index], points[index + 1], slopes[index], slopes[index + 1]
    bend = 3.0 * (p1 - p0) - 2.0 * v0 - v1
    return p0 + t * (v0 + t * (bend + t * (2.0 * (p0 - p1) + v0 + v1)))
