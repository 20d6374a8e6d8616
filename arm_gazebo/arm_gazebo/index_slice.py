"""Indices that are evenly spaced, as a slice."""

import numpy as np
from numpy.typing import NDArray


def as_slice(indices: NDArray[np.intp]) -> slice | NDArray[np.intp]:
    """Return evenly spaced, rising indices as a slice: a view instead of a copy."""
    if len(indices) == 0:
        return slice(0, 0)
    steps = np.unique(np.diff(indices))
    if len(steps) > 1 or (len(steps) == 1 and steps[0] < 1):
        return indices
    step = int(steps[0]) if len(steps) else 1
    return slice(int(indices[0]), int(indices[-1]) + 1, step)
