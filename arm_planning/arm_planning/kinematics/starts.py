"""Where a search starts anew: states whose poses are near the target, then random ones."""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from arm_planning.kinematics.chain import Chain
from arm_planning.kinematics.descent import Target

Array = NDArray[np.float64]

SAMPLES = 4096
"""States in the table: 10 ms to make, on first use. From the nearest of them a descent takes half
the steps that it takes from a random start, and succeeds two to three times as often."""
NEAREST = 48
"""Starts from the table, before random ones."""
UNLIMITED_M = 1.0
"""Half of the range that is sampled of a sliding joint without limits."""


class Starts:
    """The starts of a chain's searches, made once for a chain.

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
