"""The interfaces that a controller holds while it is active."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm_node.index_slice import as_slice


class LoanedInterfaces:
    """A view of the manager's array of states or commands, in the order that was requested.

    Evenly spaced positions, for example all positions of a robot whose joints have the same
    interfaces, become a slice, which NumPy reads and writes in a tenth of a microsecond; others
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
        """Create the view.

        Args:
            names: full name of each interface.
            array: the manager's array; read-only for states.
            positions: index of each named interface in `array`.
            data_types: type of each interface in the description; empty if all are double.
        """
        self.names = tuple(names)
        self.data_types = tuple(data_types) or ("double",) * len(self.names)
        self._array = array
        self._key = as_slice(positions)

    def __len__(self) -> int:
        return len(self.names)

    def read(self) -> NDArray[np.float64]:
        """Return the current values, shape (n,); valid until the next tick: copy to keep."""
        return self._array[self._key]

    def unknown_names(self) -> list[str]:
        """Return the names of the values that are not finite numbers."""
        pairs = zip(self.names, self.read(), strict=True)
        return [name for name, value in pairs if not np.isfinite(value)]

    def write(self, values: ArrayLike) -> None:
        """Set all values; `values` broadcasts to shape (n,)."""
        self._array[self._key] = values


class _ScatteredInterfaces(LoanedInterfaces):
    """A view of interfaces in several arrays: the hardware's and those that controllers export.

    Loop thread only.
    """

    __slots__ = ("_parts", "_values")

    def __init__(
        self,
        names: Sequence[str],
        places: Sequence[tuple[NDArray[np.float64], int]],
        data_types: Sequence[str] = (),
    ) -> None:
        """Create the view; `places` has each interface's array, and its index there."""
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
        """Return the current values, shape (n,); valid until the next read: copy to keep."""
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
    """Create the fastest view of these interfaces; see `_ScatteredInterfaces`."""
    if len({id(array) for array, _ in places}) > 1:
        return _ScatteredInterfaces(names, places, data_types)
    array = places[0][0] if places else np.empty(0)
    return LoanedInterfaces(names, array, [position for _, position in places], data_types)


MAX_NAMES_SHOWN = 8
"""How many states a message names."""


def describe_unmeasured(names: Sequence[str]) -> str:
    """Return 'state j0/position is not a number', or the plural with the first few names."""
    shown = ", ".join(names[:MAX_NAMES_SHOWN])
    more = f" and {len(names) - MAX_NAMES_SHOWN} more" if len(names) > MAX_NAMES_SHOWN else ""
    if len(names) == 1:
        return f"state {shown} is not a number"
    return f"states {shown}{more} are not numbers"
