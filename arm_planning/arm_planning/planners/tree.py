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
        self._states = np.empty((max(FIRST_ROOM, 2 * count), joints))
        self._states[:count] = roots
        self._parents = [-1] * count

    def __len__(self) -> int:
        return len(self._parents)

    def add(self, state: Array, parent: int) -> int:
        """Add a state, (n,), that was reached from another; return its index."""
        index = len(self._parents)
        if index == len(self._states):
            self._states = np.concatenate([self._states, np.empty_like(self._states)])
        self._states[index] = state
        self._parents.append(parent)
        return index

    def state(self, index: int) -> Array:
        """Return a state, (n,)."""
        return self._states[index].copy()

    def nearest(self, state: Array) -> int:
        """Return the index of the state with the smallest Euclidean distance."""
        difference = self._states[: len(self._parents)] - state
        return int(np.einsum("ij,ij->i", difference, difference).argmin())

    def path(self, index: int) -> Array:
        """Return the states from a root to one, (m, n)."""
        indices: list[int] = []
        while index >= 0:
            indices.append(index)
            index = self._parents[index]
        return self._states[indices[::-1]]
