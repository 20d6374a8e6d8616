"""Proves that a path is free, and bends it a little where it touches something between samples."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_planning.planners.problem import Deadline, StateChecker
from arm_planning.planners.space import Space

Array = NDArray[np.float64]

MOST_BENDS = 12
"""Places where a path is bent at most."""
BENDS = 24
"""New way points that are tried at one place."""
NEAREST, FARTHEST = 0.02, 0.4
"""How far they are from the path: the first and the last, in the joints' units."""
DOING = "proving that the path is free"


def mend(
    path: Array, space: Space, checker: StateChecker, seed: Sequence[int], deadline: Deadline
) -> Array | None:
    """Return a path, (m, n), of which every state is proved free: the given one if it can be.

    Returns:
        None if no bend near an obstruction can be proved.

    Raises:
        PlanningError: TIMED_OUT.
    """
    random = np.random.default_rng(seed)
    proved, rest = path[:1], path
    for _ in range(MOST_BENDS):
        deadline.check(DOING)
        obstruction = checker.prove(rest)
        if obstruction is None:
            return np.concatenate([proved[:-1], rest])
        at = obstruction.segment
        chord = rest[at : at + 2]
        place = chord[0] + np.clip(obstruction.fraction, 0.1, 0.9) * (chord[1] - chord[0])
        bent = _bend(chord, place, space, checker, random, deadline)
        if bent is None:
            return None
        proved = np.concatenate([proved[:-1], rest[: at + 1], bent, rest[at + 1 : at + 2]])
        rest = rest[at + 1 :]
        if len(rest) == 1:
            return proved
    return None


def _bend(
    chord: Array,
    place: Array,
    space: Space,
    checker: StateChecker,
    random: np.random.Generator,
    deadline: Deadline,
) -> Array | None:
    """Return way points near a place, (k, n), past which the chord's ends are connected."""
    a, b = chord
    for distance in np.geomspace(NEAREST, FARTHEST, BENDS):
        deadline.check(DOING)
        direction = random.standard_normal(len(a))
        beside = place + direction * (distance / np.linalg.norm(direction))
        point = space.project(np.clip(beside, space.lower, space.upper))
        there = None if point is None else space.connect(a, point)
        back = None if point is None or there is None else space.connect(point, b)
        if there is not None and back is not None:
            way = np.vstack([a, there, back])
            if checker.prove(way) is None:
                return way[1:-1]
    return None
