"""The interfaces a controller holds while it is active."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray


class LoanedInterfaces:
    """A window on the manager's array of states or commands, in the order the controller asked.

    Evenly spaced positions (all positions of a robot whose joints have the same interfaces, for
    example) become a slice, which NumPy reads and writes in a tenth of a microsecond; others
    become an index array. Loop thread only.
    """

    __slots__ = ("_array", "_key", "data_types", "names")

    def __init__(
        self,
        names: Sequence[str],
        array: NDArray[np.float64],
        positions: Sequence[int],
        data_types: Sequence[str] = (),
    ) -> None:
        """Open the window.

        Args:
            names: full name of each interface.
            array: the manager's array; read-only for states.
            positions: where in `array` each named interface stands.
            data_types: what the description says that each is; nothing for all double.
        """
        self.names = tuple(names)
        self.data_types = tuple(data_types) or ("double",) * len(self.names)
        self._array = array
        self._key = _as_slice(positions) or np.asarray(positions, dtype=np.intp)

    def __len__(self) -> int:
        return len(self.names)

    def read(self) -> NDArray[np.float64]:
        """Return the present values, shape (n,); valid until the next tick: copy to keep."""
        return self._array[self._key]

    def write(self, values: ArrayLike) -> None:
        """Set all values; `values` broadcasts to shape (n,)."""
        self._array[self._key] = values


def _as_slice(positions: Sequence[int]) -> slice | None:
    """Return the slice with these positions, None if there is none."""
    if not positions:
        return slice(0, 0)
    step = positions[1] - positions[0] if len(positions) > 1 else 1
    if step <= 0 or any(b - a != step for a, b in pairwise(positions)):
        return None
    return slice(positions[0], positions[-1] + 1, step)


class ScatteredInterfaces(LoanedInterfaces):
    """A window on interfaces in several arrays: hardware's, and those that controllers export.

    Loop thread only.
    """

    __slots__ = ("_parts", "_values")

    def __init__(
        self,
        names: Sequence[str],
        places: Sequence[tuple[NDArray[np.float64], int]],
        data_types: Sequence[str] = (),
    ) -> None:
        """Open the window.

        Args:
            names: full name of each interface.
            places: the array of each named interface, and where in it that stands.
            data_types: what the description says that each is; nothing for all double.
        """
        self._values = np.full(len(names), np.nan)
        super().__init__(names, self._values, range(len(names)), data_types)
        arrays = {id(array): array for array, _ in places}
        self._parts = [
            (
                where,
                LoanedInterfaces([names[i] for i in where], array, [places[i][1] for i in where]),
            )
            for array in arrays.values()
            if (where := [i for i, place in enumerate(places) if place[0] is array])
        ]

    def read(self) -> NDArray[np.float64]:
        """Return the present values, shape (n,); valid until the next read: copy to keep."""
        for where, part in self._parts:
            self._values[where] = part.read()
        return self._values

    def write(self, values: ArrayLike) -> None:
        """Set all values; `values` broadcasts to shape (n,)."""
        every = np.broadcast_to(np.asarray(values, dtype=np.float64), self._values.shape)
        for where, part in self._parts:
            part.write(every[where])


def loan(
    names: Sequence[str],
    places: Sequence[tuple[NDArray[np.float64], int]],
    data_types: Sequence[str] = (),
) -> LoanedInterfaces:
    """Open the quickest window on these interfaces; see `ScatteredInterfaces`."""
    if len({id(array) for array, _ in places}) > 1:
        return ScatteredInterfaces(names, places, data_types)
    array = places[0][0] if places else np.empty(0)
    return LoanedInterfaces(names, array, [position for _, position in places], data_types)
