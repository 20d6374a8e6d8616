"""Makes a path shorter: straight ways between its points, and corners pulled in.

R. Geraerts, M. Overmars: Creating high-quality paths for motion planning, 2007, compares such
methods. The number of trials depends on the path alone, never on time.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_planning.planners.problem import Deadline, path_length
from arm_planning.planners.space import Space

Array = NDArray[np.float64]

TRIALS = 120
"""Random shortcuts that are tried at most."""
PATIENCE = 25
"""Ends after so many of them in a row without a gain."""
GAIN = 0.005
"""Share of the path's length that a shortcut must save to be tried."""
PULLS = 3
"""Rounds in which each corner is pulled in."""
DOING = "shortening the path"


def shorten(path: Array, space: Space, seed: Sequence[int], deadline: Deadline) -> Array:
    """Return a path with the same ends, (m, n), that is not longer.

    Raises:
        PlanningError: TIMED_OUT: a path that is shortened only in part would depend on the load.
    """
    path = _without_detours(path, space, deadline)
    random = np.random.default_rng(seed)
    idle = 0
    for _ in range(TRIALS):
        if len(path) == 2 or idle == PATIENCE:
            break
        deadline.check(DOING)
        shorter = _shortcut(path, space, random.uniform(size=2))
        idle = idle + 1 if shorter is None else 0
        path = path if shorter is None else shorter
    return path


def _without_detours(path: Array, space: Space, deadline: Deadline) -> Array:
    """Go from each point to the last one that can be reached straight."""
    kept = [path[:1]]
    at = 0
    while at < len(path) - 1:
        for ahead in range(len(path) - 1, at + 1, -1):
            deadline.check(DOING)
            states, reached = space.move(path[at], path[ahead])
            if reached and path_length(np.vstack([path[at], states])) <= path_length(
                path[at : ahead + 1]
            ):
                kept.append(states)
                at = ahead
                break
        else:
            kept.append(path[at + 1 : at + 2])
            at += 1
    return np.concatenate(kept)


def _shortcut(path: Array, space: Space, parts: Array) -> Array | None:
    """Try the straight way between two points that are at parts of the path's length, (2,)."""
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    total = float(lengths[-1])
    first, second = np.sort(parts) * total
    before, after = np.searchsorted(lengths, (first, second), side="right") - 1
    if before == after:
        return None
    a, b = (_point(path, lengths, index, at) for index, at in ((before, first), (after, second)))
    if second - first - float(np.linalg.norm(b - a)) < GAIN * total:
        return None
    states, reached = space.move(a, b)
    if not reached or path_length(np.vstack([a, states])) >= second - first:
        return None
    return np.concatenate([path[: before + 1], a[None, :], states, path[after + 1 :]])


def _point(path: Array, lengths: Array, index: int, at: float) -> Array:
    part = (at - lengths[index]) / (lengths[index + 1] - lengths[index])
    return path[index] + part * (path[index + 1] - path[index])
