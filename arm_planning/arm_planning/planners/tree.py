"""A tree of states that grows from roots."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FIRST_ROOM = 256


class Tree:
    """States, each with the one that it was reached from.

    Args:
        roots: the states to grow from, (r, n).
    """

    def __init__(self, roots: Array) -> None:
        count, joints = roots.shape
        # A row for each joint: the search for the nearest state then adds long rows.
        self._states = np.empty((joints, max(FIRST_ROOM, 2 * count)))
        self._states[:, :count] = roots.T
        self._parents = [-1] * count

    def __len__(self) -> int:
        return len(self._parents)

    def add(self, state: Array, parent: int) -> int:
        """Add a state, (n,), that was reached from another; return its index."""
        index = len(self._parents)
        if index == self._states.shape[1]:
            self._states = np.hstack([self._states, np.empty_like(self._states)])
        self._states[:, index] = state
        self._parents.append(parent)
        return index

    def state(self, index: int) -> Array:
        """Return a state, (n,)."""
        return self._states[:, index].copy()

    def nearest(self, state: Array) -> int:
        """Return the index of the state with the smallest Euclidean distance."""
        squares = self._states[:, : len(self._parents)] - state[:, None]
        np.multiply(squares, squares, out=squares)
        return int(squares.sum(axis=0).argmin())

    def path(self, index: int) -> Array:
        """Return the states from a root to one, (m, n)."""
        indices: list[int] = []
        while index >= 0:
            indices.append(index)
            index = self._parents[index]
        return self._states.T[indices[::-1]]
