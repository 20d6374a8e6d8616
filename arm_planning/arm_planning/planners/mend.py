"""Proves that a path is free, and bends it a little where it touches something between samples."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_planning.planners.problem import Deadline, StateChecker, length
from arm_planning.planners.space import Space

Array = NDArray[np.float64]

MOST_BENDS = 12
"""Places where a path is bent at most."""
BENDS = 24
"""Bends that are tried at one place."""
NEAREST, FARTHEST = 0.02, 0.4
"""How far they lead from the path: the first and the last, in the joints' units."""
CLOSE = 0.2
"""Way points that are as close as this to the place are moved with it."""
SAME_PLACE = 0.02
"""Places that are as close as this are one place: it cannot be bent if the other could not."""
SPREAD = 2.0
"""How much chance has a part in the last one's direction; the first leads straight away."""
DOING = "proving that the path is free"


def mend(
    path: Array,
    space: Space,
    checker: StateChecker,
    seed: Sequence[int],
    deadline: Deadline,
    stuck: list[Array],
) -> Array | None:
    """Return a path, (m, n), of which every state is proved free: the given one if it can be.

    Args:
        path: way points.
        space: where bends may lead.
        checker: proves it.
        seed: seed of the bends' directions.
        deadline: when the answer is due.
        stuck: places, (n,) each, where no bend could be proved. Bends are not tried there again,
            and another such place is appended.

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
        first, last = obstruction.segment, obstruction.segment + 1
        place = rest[first] + obstruction.fraction * (rest[last] - rest[first])
        if any(length(place - other) < SAME_PLACE for other in stuck):
            return None
        points = np.insert(rest, last, place, axis=0)
        last += 1
        # Way points next to it are as close to what is in the way.
        while first > 0 and length(points[first] - place) < CLOSE:
            first -= 1
        while last < len(rest) and length(points[last] - place) < CLOSE:
            last += 1
        bent = _bent(points[first : last + 1], obstruction.away, space, checker, random, deadline)
        if bent is None:
            stuck.append(place)
            return None
        proved, rest = np.concatenate([proved[:-1], rest[:first], bent]), points[last:]
        if len(rest) == 1:
            return proved
    return None


def _bent(
    points: Array,
    away: Array | None,
    space: Space,
    checker: StateChecker,
    random: np.random.Generator,
    deadline: Deadline,
) -> Array | None:
    """Return a proved path, (k, n), with the same ends, whose other points are moved away."""
    for chance, distance in zip(
        np.linspace(0.0, SPREAD, BENDS), np.geomspace(NEAREST, FARTHEST, BENDS), strict=True
    ):
        deadline.check(DOING)
        anywhere = random.standard_normal(points.shape[1])
        direction = anywhere if away is None else away + chance * anywhere / length(anywhere)
        way = _connected(points, direction * (distance / length(direction)), space)
        if way is not None and checker.prove(way) is None:
            return way
    return None


def _connected(points: Array, move: Array, space: Space) -> Array | None:
    """Return the path, (k, n), from the first point past the others, moved, to the last."""
    way = points[:1]
    for point in points[1:-1] + move:
        near = space.project(np.clip(point, space.lower, space.upper))
        states = None if near is None else space.connect(way[-1], near)
        if states is None:
            return None
        way = np.concatenate([way, states])
    states = space.connect(way[-1], points[-1])
    return None if states is None else np.concatenate([way, states])
