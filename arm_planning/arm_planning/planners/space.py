"""The states that a path may use: free ones, and those that satisfy constraints on the way."""

from abc import ABC, abstractmethod
from functools import lru_cache
from math import ceil

import numpy as np
from numpy.typing import NDArray

from arm_planning.constraints.evaluation import ConstraintEvaluator
from arm_planning.planners.problem import PlanningProblem, StateChecker, length

Array = NDArray[np.float64]

SAMPLE_STEP = 0.07
"""Largest change of a joint between two samples of a straight move, rad or m."""
SEARCH_STEP = 0.1
"""The same for the moves of a search: few of them are part of the path, which is proved."""
CLEARANCE_M = 0.002
"""Distance that samples keep in a space with clearance: what lies between them is then seldom too
close for a proof."""
BACK_OFF = 1
"""How many samples before an obstacle a move stops: the next one may already touch it."""
SHORTEST = 0.2
"""Length of a move that is worth it although it does not reach its target."""
PARTS = (1.0, 0.25)
"""Shares of a proved move that are tried."""
STEP = 0.05
"""Distance of two states on a constrained path, rad or m."""
TIGHTER = 0.9
"""Share of a tolerance that projected states use: between them, a path may use the rest."""
PROJECTION_STEPS = 12
DIFFERENCE = 1e-6
"""Step of numeric derivatives, rad or m."""
PROJECTED = 1e-7
"""Residual below which a state counts as projected; it is far below what `TIGHTER` leaves."""
TURN = np.pi
"""How far from the start a continuous joint is sampled, rad."""


class Space(ABC):
    """The states that a search may use, and how it moves from one to another.

    Args:
        checker: what is free.
        lower: lower bounds of states to sample, (n,).
        upper: their upper bounds.
    """

    def __init__(self, checker: StateChecker, lower: Array, upper: Array) -> None:
        self.lower, self.upper = lower, upper
        self._checker = checker

    def with_clearance(self, ends: Array) -> "Space":
        """Return a space in which paths with these ends, (k, n), are more likely to be proved.

        By default it is the space itself: its moves are proved.
        """
        return self

    def project(self, q: Array) -> Array | None:
        """Return a state near to one, (n,), that satisfies the constraints; None without any.

        By default there are no constraints.
        """
        return q

    @abstractmethod
    def advance(self, a: Array, b: Array) -> tuple[Array, bool]:
        """Go from a state towards another as far as it is worth it.

        Returns:
            The states after `a`, (k, n), and whether the last is `b`.
        """

    @abstractmethod
    def connect(self, a: Array, b: Array) -> Array | None:
        """Return the states after `a` on the way to `b`, (k, n); None if something blocks it."""


def space_of(problem: PlanningProblem, goals: Array, *, is_proved: bool = False) -> Space:
    """Return the space in which paths to some goals, (g, n), are searched.

    Args:
        problem: the problem.
        goals: the states that paths may end in.
        is_proved: whether moves are proved, which takes several times as long as samples do.
    """
    states = np.vstack([problem.start, goals])
    group = problem.group
    # Half a turn each way for continuous joints; goals may be farther.
    lower = np.where(group.continuous, problem.start - TURN, group.lower)
    upper = np.where(group.continuous, problem.start + TURN, group.upper)
    lower, upper = np.minimum(lower, states.min(axis=0)), np.maximum(upper, states.max(axis=0))
    if problem.path is not None and problem.path.constraints:
        return ConstrainedSpace(problem.checker, problem.path, lower, upper)
    kind = ProvedSpace if is_proved else SampledSpace
    return kind(problem.checker, lower, upper)


class SampledSpace(Space):
    """Free states; a straight move counts as free if samples of it are.

    A path of such moves is proved afterwards: most are free, and samples are much faster.

    Args:
        checker: see `Space`.
        lower: likewise.
        upper: likewise.
        clearance_m: distance that a move all of the way keeps from what is around.
    """

    def __init__(
        self, checker: StateChecker, lower: Array, upper: Array, clearance_m: float = 0.0
    ) -> None:
        super().__init__(checker, lower, upper)
        self._free_count, self._clearance_m = checker.free_count, clearance_m

    def with_clearance(self, ends: Array) -> Space:
        """Return a space whose moves keep some clearance, if the ends have it."""
        if self._free_count(ends, CLEARANCE_M) < len(ends):
            return self
        return SampledSpace(self._checker, self.lower, self.upper, CLEARANCE_M)

    def advance(self, a: Array, b: Array) -> tuple[Array, bool]:
        """Go straight until something blocks, and stop a little before it."""
        change = b - a
        count = _samples(change, SEARCH_STEP)
        step = change / count
        # Most moves are blocked soon, so the sample without which they are too short comes first.
        least = min(ceil(SHORTEST / max(length(step), SHORTEST / count)) + BACK_OFF, count)
        free = self._free_count(a + _one_after_the_other(count, least) * step)
        if free == count:
            return b[None, :], True
        kept = free - BACK_OFF if free >= least else 0
        return (a + kept * step)[None, :] if kept else np.empty((0, len(a))), False

    def connect(self, a: Array, b: Array) -> Array | None:
        """Go straight; samples are taken in the order in which they find obstacles soonest."""
        change = b - a
        count = _samples(change, SAMPLE_STEP)
        states = a + _from_coarse_to_fine(count) * (change / count)
        return b[None, :] if self._free_count(states, self._clearance_m) == count else None


@lru_cache(maxsize=1024)
def _one_after_the_other(count: int, first: int) -> Array:
    """Return the numbers from 1 to a count, (count, 1), with one of them moved to the front."""
    numbers = [first, *range(1, first), *range(first + 1, count + 1)]
    return np.array(numbers, np.float64)[:, None]


@lru_cache(maxsize=256)
def _from_coarse_to_fine(count: int) -> Array:
    """Return them with the middle first, then those between, and so on; the last is last.

    Moves mostly end in states that are known to be free.
    """
    order, spans = [], [(0, count)]
    for low, high in spans:
        middle = (low + high) // 2
        if middle > low:
            order.append(middle)
            spans += ((low, middle), (middle, high))
    return np.array([*order, count], np.float64)[:, None]


def _samples(change: Array, step: float) -> int:
    # On so few numbers NumPy is slower.
    return int(max(map(abs, change.tolist())) / step) + 1


class ProvedSpace(Space):
    """Free states; each straight move is proved."""

    def advance(self, a: Array, b: Array) -> tuple[Array, bool]:
        """Go straight, all of the way or the first part of it."""
        for share in PARTS:
            target = b if share == 1.0 else a + share * (b - a)
            if self.connect(a, target) is not None:
                return target[None, :], share == 1.0
        return np.empty((0, len(a))), False

    def connect(self, a: Array, b: Array) -> Array | None:
        """Go straight, or not at all."""
        return b[None, :] if self._checker.is_free_edge(a, b) else None


class ConstrainedSpace(Space):
    """Free states that satisfy constraints; moves are small steps, each projected.

    The projection is Gauss-Newton on how far each component is outside of its tolerance. After
    D. Berenson et al.: Manipulation planning on constraint manifolds, 2009.
    """

    def __init__(
        self, checker: StateChecker, path: ConstraintEvaluator, lower: Array, upper: Array
    ) -> None:
        super().__init__(checker, lower, upper)
        self._path = path
        self._tight = path.tightened(TIGHTER)

    def project(self, q: Array) -> Array | None:
        """Return a state near to one that satisfies the constraints within the limits."""
        for _ in range(PROJECTION_STEPS):
            residual = self._tight.residual(q)
            if np.abs(residual).max() < PROJECTED:
                return q
            jacobian = self._jacobian(q, residual)
            q = np.clip(q - np.linalg.pinv(jacobian, rcond=1e-4) @ residual, self.lower, self.upper)
        return q if np.abs(self._tight.residual(q)).max() < PROJECTED else None

    def connect(self, a: Array, b: Array) -> Array | None:
        """Go along the constraints to a state."""
        states, reached = self.advance(a, b)
        return states if reached else None

    def advance(self, a: Array, b: Array) -> tuple[Array, bool]:
        """Go towards a state in small steps along the constraints, until something blocks."""
        states = [a]
        while True:
            here = states[-1]
            left = float(np.abs(b - here).max())
            if left <= STEP:
                reached = self._is_clear(here, b)
                if reached:
                    states.append(b)
                break
            there = self.project(here + (b - here) * (STEP / left))
            # A projection that leads back makes no progress; one that leads far away is a jump.
            if there is None or not self._is_progress(here, there, b):
                reached = False
                break
            if not self._is_clear(here, there):
                reached = False
                break
            states.append(there)
        return np.array(states[1:]).reshape(-1, len(a)), reached

    def _is_progress(self, here: Array, there: Array, goal: Array) -> bool:
        nearer = np.linalg.norm(goal - there) < np.linalg.norm(goal - here) - STEP / 10.0
        return bool(nearer) and float(np.abs(there - here).max()) < 2.0 * STEP

    def _is_clear(self, a: Array, b: Array) -> bool:
        """Whether a short move is free and satisfies the constraints, looked at in 4 places."""
        between = (a + (b - a) * part for part in (0.25, 0.5, 0.75, 1.0))
        return all(map(self._path.satisfied, between)) and self._checker.is_free_edge(a, b)

    def _jacobian(self, q: Array, residual: Array) -> Array:
        columns: list[Array] = []
        for index in range(len(q)):
            moved = q.copy()
            moved[index] += DIFFERENCE
            columns.append((self._tight.residual(moved) - residual) / DIFFERENCE)
        return np.array(columns).T
