"""Makes a path shorter: straight ways between its points, and corners pulled in.

R. Geraerts, M. Overmars: Creating high-quality paths for motion planning, 2007, compares such
methods. The number of trials depends on the path alone, never on time.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_planning.planners.problem import Deadline, length, path_length
from arm_planning.planners.space import Space

Array = NDArray[np.float64]

TRIALS = 60
"""Random shortcuts that are tried at most."""
PATIENCE = 6
"""Ends them after so many in a row without a gain."""
GAIN = 0.01
"""Share of the path's length that a random shortcut must save to be tried."""
ROUNDS = 4
"""How often each corner is cut, at most."""
CUTS = (1.0, 0.5)
"""Shares of the shorter side that a corner's cut takes away; 1 leaves the corner out."""
LEAST_CUT = 0.03
"""Length that a cut must save to be tried, in the joints' units."""
DOING = "shortening the path"


def shorten(path: Array, space: Space, seed: Sequence[int], deadline: Deadline) -> Array:
    """Return a path with the same ends, (m, n), that is not longer.

    Raises:
        PlanningError: TIMED_OUT: a path that is shortened only in part would depend on the load.
    """
    space = space.with_clearance(path[[0, -1]])
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
    return _with_cut_corners(path, space, deadline)


def _with_cut_corners(path: Array, space: Space, deadline: Deadline) -> Array:
    # What was not cut in one round, with the same points, is not in the next.
    stuck: set[bytes] = set()
    for _ in range(ROUNDS):
        before, corner = path_length(path), 1
        while corner < len(path) - 1:
            deadline.check(DOING)
            points = path[corner - 1 : corner + 2]
            cut = None if points.tobytes() in stuck else _cut(points, space)
            if cut is None:
                stuck.add(points.tobytes())
                corner += 1
            else:
                # One way point less, or a new corner, whose turn is in the next round.
                path = np.concatenate([path[:corner], cut, path[corner + 1 :]])
                corner += max(len(cut), 1)
        if before - path_length(path) < LEAST_CUT:
            break
    return path


def _cut(corner: Array, space: Space) -> Array | None:
    """Return way points, (k, n), that cut a corner of three points, (3, n); None if blocked."""
    before, middle, after = corner
    sides = length(before - middle), length(after - middle)
    for share in CUTS:
        reach = share * min(sides)
        a = before if share == 1.0 else middle + (before - middle) * (reach / sides[0])
        b = after if share == 1.0 else middle + (after - middle) * (reach / sides[1])
        around = length(a - middle) + length(b - middle)
        if around - length(b - a) < LEAST_CUT:
            return None
        states = space.connect(a, b)
        if states is not None and _length_over(a, states) < around:
            return states[:-1] if share == 1.0 else np.vstack([a, states])
    return None


def _without_detours(path: Array, space: Space, deadline: Deadline) -> Array:
    """Go from each point to the last one that can be reached straight."""
    kept = [path[:1]]
    at = 0
    while at < len(path) - 1:
        for ahead in range(len(path) - 1, at + 1, -1):
            deadline.check(DOING)
            states = space.connect(path[at], path[ahead])
            if states is not None and _length_over(path[at], states) <= path_length(
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
    sides = path[1:] - path[:-1]
    lengths = np.zeros(len(path))
    np.cumsum(np.sqrt(np.einsum("ij,ij->i", sides, sides)), out=lengths[1:])
    total = float(lengths[-1])
    first, second = np.sort(parts) * total
    before, after = np.searchsorted(lengths, (first, second), side="right") - 1
    if before == after:
        return None
    a, b = (_point(path, lengths, index, at) for index, at in ((before, first), (after, second)))
    if second - first - length(b - a) < GAIN * total:
        return None
    states = space.connect(a, b)
    if states is None or _length_over(a, states) >= second - first:
        return None
    return np.concatenate([path[: before + 1], a[None, :], states, path[after + 1 :]])


def _length_over(start: Array, states: Array) -> float:
    """Return the length of the way from a state, (n,), over others, (k, n); mostly there is one."""
    first = length(states[0] - start)
    return first if len(states) == 1 else first + path_length(states)


def _point(path: Array, lengths: Array, index: int, at: float) -> Array:
    part = (at - lengths[index]) / (lengths[index + 1] - lengths[index])
    return path[index] + part * (path[index + 1] - path[index])
