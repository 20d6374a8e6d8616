"""Finds a state in which nothing touches by moving apart what touches, one pair after the other.

A robot of many joints, such as a humanoid, touches something in nearly every random state; this
search leaves the joints alone that have nothing to do with it.
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from arm_planning.collision.contact import CollisionContact

Array = NDArray[np.float64]

TRIALS = 3_000
"""States to look at before the search is given up."""
GIVE_UP = 100
"""Vain trials with one pair before another one is moved."""


def find_by_repair(
    start: Array,
    limits: tuple[Array, Array],
    contacts: Callable[[Array], Sequence[CollisionContact]],
    movers: Callable[[CollisionContact], Sequence[int]],
) -> Array | None:
    """Return a state near `start` without contacts; None if none is found.

    The same robot gives the same state.

    Args:
        start: positions of the joints, (n,), rad or m.
        limits: the least and the greatest positions, (n,) each.
        contacts: returns what touches in a state, the deepest first.
        movers: returns the indices of the joints that move the two of a contact apart.
    """
    rng = np.random.default_rng(0)
    lower, upper = limits
    q, touching, vain = start.copy(), tuple(contacts(start)), 0
    for number in range(TRIALS):
        if not touching:
            return q
        moved = list(movers(touching[(vain // GIVE_UP) % len(touching)]))
        trial = q.copy()
        anywhere = rng.uniform(lower[moved], upper[moved])
        # Near the start first, then farther and farther away.
        trial[moved] = start[moved] + number / TRIALS * (anywhere - start[moved])
        after = tuple(contacts(trial))
        if _depth(after) < _depth(touching):
            q, touching, vain = trial, after, 0
        else:
            vain += 1
    return None


def _depth(touching: Sequence[CollisionContact]) -> float:
    """Return how deep all pairs are in each other together, m."""
    return sum(contact.depth_m for contact in touching)
