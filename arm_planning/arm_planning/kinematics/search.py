"""One call of inverse kinematics: what it looks for, where it starts, and why it found nothing."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from arm_node.names import listing
from arm_planning.kinematics.chain import Chain
from arm_planning.kinematics.descent import DescentEnd, Target

Array = NDArray[np.float64]

SAMPLES = 4096
"""States in the table: 10 ms to make, on first use. From the nearest of them a descent takes half
the steps that it takes from a random start, and succeeds two to three times as often."""
NEAREST = 48
"""Starts from the table, before random ones."""
UNLIMITED_M = 1.0
"""Half of the range that is sampled of a sliding joint without limits."""
AT_LIMIT = 1e-6
FULL_POSE_JOINTS = 6


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


class Starts:
    """Where a search starts anew: states whose poses are near the target, then random ones.

    Made once for a chain.

    Args:
        chain: what is moved.
        lower: lower limits, (n,), or -inf.
        upper: upper limits, (n,), or inf.
        turning: whether each joint turns, (n,).
    """

    def __init__(
        self, chain: Chain, lower: Array, upper: Array, turning: NDArray[np.bool_]
    ) -> None:
        reach = np.where(turning, math.pi, UNLIMITED_M)
        self._lower = np.where(np.isfinite(lower), lower, np.minimum(-reach, upper - 2.0 * reach))
        self._upper = np.where(np.isfinite(upper), upper, np.maximum(reach, lower + 2.0 * reach))
        self._states = self._sample(np.random.default_rng(0), SAMPLES)
        self._positions, self._conjugates = np.empty((SAMPLES, 3)), np.empty((SAMPLES, 4))
        for row, state in enumerate(self._states):
            chain.place(state)
            self._positions[row], self._conjugates[row] = chain.position, chain.quaternion
        self._conjugates[:, 1:] *= -1.0
        self._squares = (self._positions**2).sum(axis=1)

    def towards(self, target: Target, seed: int) -> Iterator[Array]:
        """Yield starts without end, (n,) each; the same for the same target and seed."""
        # |p - t|^2 without |t|^2; 8 (1 - |q t|) is about the squared angle.
        nearness = self._squares - self._positions @ (2.0 * target.position)
        if target.rotation_length:
            alike = np.abs(self._conjugates @ (8.0 * target.rotation_length**2 * target.back))
            nearness -= alike
        # Most searches need one start, so the others are put in order later.
        first = int(nearness.argmin())
        yield self._states[first]
        nearness[first] = math.inf
        near = np.argpartition(nearness, NEAREST)[:NEAREST]
        yield from self._states[near[np.argsort(nearness[near], kind="stable")]]
        random = np.random.default_rng(seed)
        while True:
            yield from self._sample(random, NEAREST)

    def _sample(self, random: np.random.Generator, count: int) -> Array:
        return random.uniform(self._lower, self._upper, (count, len(self._lower)))


def shortfall(
    search: Search, tip: str, joints: Sequence[str], lower: Array, upper: Array, chain: Chain
) -> str:
    """Return the sentence that says why a search found nothing, and how near it came.

    Args:
        search: the search that found nothing.
        tip: the link that was to be placed.
        joints: the joints that move it.
        lower: their lower limits, (n,).
        upper: their upper limits, (n,).
        chain: their kinematics.
    """
    x, y, z = search.target.position
    place = f"({x:.3f}, {y:.3f}, {z:.3f}) m"
    exact = search.orientation is Orientation.EXACT
    turned = " in the given orientation" if exact else ""
    if search.blocked:
        found = (
            "the only solution found is"
            if search.blocked == 1
            else (f"all {search.blocked} solutions found are")
        )
        return f"link '{tip}' can reach {place}{turned}, but {found} in collision"
    best = search.best
    assert best is not None, "a search without solutions has failed descents"
    angle = f" and {_rounded(math.degrees(best.off_rad))} degrees" if exact else ""
    return (
        f"link '{tip}' cannot reach {place}{turned}: the best pose is off by "
        f"{_rounded(best.off_m * 1e3)} mm{angle}"
        + _too_short(search, chain)
        + _at_limits(best, joints, lower, upper)
        + _too_few(joints, exact)
    )


def _too_short(search: Search, chain: Chain) -> str:
    if not chain.is_too_short_for(search.target.position):
        return ""
    distance = float(np.linalg.norm(search.target.position - chain.anchor))
    return (
        f"; the place is {distance:.3f} m from the first joint, and the arm is "
        f"{chain.reach_m:.3f} m long"
    )


def _at_limits(best: DescentEnd, joints: Sequence[str], lower: Array, upper: Array) -> str:
    at_limit = (best.q - lower < AT_LIMIT) | (upper - best.q < AT_LIMIT)
    names = [name for name, at in zip(joints, at_limit, strict=True) if at]
    if not names:
        return ""
    be, plural = ("is", "") if len(names) == 1 else ("are", "s")
    return f"; there joint{plural} {listing(names)} {be} at the limit{plural}"


def _too_few(joints: Sequence[str], exact: bool) -> str:
    if not exact or len(joints) >= FULL_POSE_JOINTS:
        return ""
    return (
        f"; with {len(joints)} joints most orientations cannot be had at a place: ask for the "
        "nearest orientation, or for the position alone"
    )


def _rounded(number: float) -> str:
    """Return two digits of a number, and 0 for what nobody can measure."""
    if number >= 99.5:
        return f"{number:.0f}"
    return f"{number if number >= 1e-3 else 0.0:.2g}"
