"""The states of joints over time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

QUANTITIES = ("position", "velocity", "effort")
FIRST_CAPACITY = 1024


@dataclass(frozen=True, slots=True)
class ReferenceLine:
    """A value that an assertion compares a joint with, drawn as a line in plots.

    Attributes:
        quantity: position, velocity or effort.
        joint: name of the joint.
        value: in the unit of the quantity.
    """

    quantity: str
    joint: str
    value: float


class StateHistory:
    """The states of joints, one row for each time. One thread adds; any thread reads.

    Attributes:
        names: names of the n joints.
        units: rad or m for each joint; "" where it is not known.
        guides: the values that assertions compared the states with.
    """

    def __init__(self, names: Sequence[str], units: Sequence[str] = ()) -> None:
        self.names = tuple(names)
        self.units = tuple(units) or ("",) * len(self.names)
        self.guides: list[ReferenceLine] = []
        self._rows = np.empty((FIRST_CAPACITY, 1 + len(QUANTITIES) * len(self.names)))
        self._count = 0

    def __len__(self) -> int:
        return self._count

    def add(
        self, time_s: float, position: ArrayLike, velocity: ArrayLike, effort: ArrayLike
    ) -> None:
        """Add the states at a time, each of shape (n,)."""
        index, count = self._count, len(self.names)
        if index == len(self._rows):
            self._rows = np.concatenate([self._rows, np.empty_like(self._rows)])
        row = self._rows[index]
        row[0] = time_s
        row[1 : 1 + count] = position
        row[1 + count : 1 + 2 * count] = velocity
        row[1 + 2 * count :] = effort
        self._count = index + 1

    def clear(self) -> None:
        """Forget all states and guides."""
        self._count = 0
        self.guides = []

    @property
    def times_s(self) -> Array:
        """The times, shape (m,)."""
        return self._filled()[:, 0]

    @property
    def position(self) -> Array:
        """Positions in rad or m, shape (m, n)."""
        return self.of("position")

    @property
    def velocity(self) -> Array:
        """Velocities in rad/s or m/s, shape (m, n)."""
        return self.of("velocity")

    @property
    def effort(self) -> Array:
        """Efforts in N m or N, shape (m, n)."""
        return self.of("effort")

    def of(self, quantity: str) -> Array:
        """Return the values of one of `QUANTITIES`, shape (m, n)."""
        first = 1 + QUANTITIES.index(quantity) * len(self.names)
        return self._filled()[:, first : first + len(self.names)]

    def unit(self, joint: str, quantity: str) -> str:
        """Return the unit of a joint's quantity; "" where it is not known."""
        unit = self.units[self.names.index(joint)]
        if not unit or quantity == "position":
            return unit
        return f"{unit}/s" if quantity == "velocity" else {"rad": "N m", "m": "N"}[unit]

    def _filled(self) -> Array:
        # Read the count first: a row is complete before it is counted, and later arrays contain it
        # too.
        count = self._count
        filled = self._rows[:count]
        filled.flags.writeable = False
        return filled
