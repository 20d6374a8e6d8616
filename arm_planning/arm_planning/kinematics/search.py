"""What one call of inverse kinematics looks for, and what it comes upon."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from arm_planning.kinematics.descent import DescentEnd, Target

Array = NDArray[np.float64]


class Orientation(StrEnum):
    """What a solution owes to the target's orientation."""

    EXACT = "exact"
    NEAREST = "nearest"
    ANY = "any"


@dataclass(slots=True, eq=False)
class Search:
    """One call of inverse kinematics: what it looks for, and what it has come upon.

    Attributes:
        target: the pose.
        orientation: what is owed to its orientation.
        seed: the user's seed inside the limits, (n,).
        random_seed: seed of the random starts.
        free: the user's predicate.
        steps: how many are left.
        until_s: when the clock ends it.
        best: the nearest pose that is not a solution.
        blocked: how many solutions are not free.
    """

    target: Target
    orientation: Orientation
    seed: Array
    random_seed: int
    free: Callable[[Array], bool] | None
    steps: int
    until_s: float
    best: DescentEnd | None = None
    blocked: int = 0

    def distance(self, q: Array) -> float:
        """Return how far positions are from the seed."""
        return float(np.linalg.norm(q - self.seed))

    def note(self, outcome: DescentEnd) -> None:
        """Keep a descent that ended short of a solution, if it is the nearest."""
        if self.best is None or self._size(outcome) < self._size(self.best):
            self.best = outcome

    def _size(self, outcome: DescentEnd) -> float:
        return outcome.off_m + self.target.rotation_length * outcome.off_rad
