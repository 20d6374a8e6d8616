"""Converts evenly spaced indices to a slice, which NumPy reads and writes faster."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


def as_slice(indices: Sequence[int] | NDArray[np.intp]) -> slice | NDArray[np.intp]:
    """Return evenly spaced, increasing indices as a slice, and any others as an index array.

    Store the result and index with it each time. Never store `array[result]` to write to it: it
    is a view for a slice but a copy for an index array.
    """
    indices = np.asarray(indices, dtype=np.intp)
    if len(indices) == 0:
        return slice(0, 0)
    steps = np.diff(indices)
    step = int(steps[0]) if len(steps) else 1
    if step < 1 or (steps != step).any():
        return indices
    return slice(int(indices[0]), int(indices[-1]) + 1, step)
