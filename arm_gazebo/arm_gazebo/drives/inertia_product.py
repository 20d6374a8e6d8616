"""MuJoCo's product of an inertia matrix and a vector, for many states at once and bit for bit."""

import mujoco
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class InertiaProduct:
    """Multiplies the sparse inertia matrices of many states of one model with their motions.

    The terms are added in the order of `mj_mulM`: rows from the first to the last, in each the
    diagonal first and then from right to left. Terms that are 0 for every motion are left out.

    Args:
        model: the model.
        spread: shape (nv, n): the motion of all degrees of freedom for a unit of each input. Each
            row has one entry other than 0 at most, as the coupling of mimic joints has.
    """

    def __init__(self, model: mujoco.MjModel, spread: Array) -> None:
        self._nv = model.nv
        sources: dict[int, tuple[int, float]] = {}
        for dof in range(model.nv):
            for column in np.flatnonzero(spread[dof]).tolist():
                sources[dof] = (column, float(spread[dof, column]))
        self._motions = tuple((dof, *source) for dof, source in sources.items())
        self._terms = tuple(
            (row, entry, dof) for row, entry, dof in _terms(model) if dof in sources
        )

    def terms(self) -> tuple[tuple[int, int, int, float], ...]:
        """Return the terms in their order: row, index in `M`, input of `spread`, its factor."""
        sources = {dof: (column, factor) for dof, column, factor in self._motions}
        return tuple((row, entry, *sources[dof]) for row, entry, dof in self._terms)

    def __call__(self, inertia: Array, gains: Array) -> Array:
        """Return the products (states, nv) of MuJoCo's `M` (states, nC) and `gains` (states, n)."""
        # One column after the other: contiguous, so that each operation is one pass.
        entries, inputs = np.ascontiguousarray(inertia.T), np.ascontiguousarray(gains.T)
        motion = {dof: inputs[column] * factor for dof, column, factor in self._motions}
        loads = np.zeros((self._nv, len(inertia)))
        for row, entry, dof in self._terms:
            loads[row] += entries[entry] * motion[dof]
        return np.ascontiguousarray(loads.T)


def _terms(model: mujoco.MjModel) -> list[tuple[int, int, int]]:
    """Return (row, index in M, column) of the products that `mj_mulM` adds up, in its order."""
    terms: list[tuple[int, int, int]] = []
    for row in range(model.nv):
        diagonal = int(model.M_rowadr[row] + model.M_rownnz[row] - 1)
        terms.append((row, diagonal, row))
        for entry in range(diagonal - 1, int(model.M_rowadr[row]) - 1, -1):
            column = int(model.M_colind[entry])
            terms += [(row, entry, column), (column, entry, row)]
    return terms
