"""RRT-Connect: a tree from the start and one from the goals grow until they meet.

J. Kuffner, S. LaValle: RRT-Connect: An efficient approach to single-query path planning, 2000. Two
things differ, because an end in a narrow place decides how long a search takes. The smaller tree
grows, not each in turn: it is the one that has not found its way out. And most samples are near to
a state of that tree: samples from everywhere pull it against the same walls again and again.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from arm_planning.planners.problem import length
from arm_planning.planners.space import Space

Array = NDArray[np.float64]

BLOCK = 64
"""Samples whose random numbers are drawn at once."""
REACH = 2.0
"""Longest move, in the joints' units. Longer ones end soon where there is room; shorter ones make
shorter paths, and turn more corners."""
NEARBY = 0.7
"""Share of samples that are near to a state of the tree; the others are anywhere."""
SPREAD = 0.18
"""Standard deviation of their distance from it, as a share of each joint's range."""
FIRST_ROOM = 256
"""States that a tree has room for at first."""


class _StateTree:
    """States that grow from roots, each with the one that it was reached from.

    Args:
        roots: the states to grow from, (r, n).
    """

    def __init__(self, roots: Array) -> None:
        count, joints = roots.shape
        # A row for each joint: the search for the nearest state then adds long rows.
        self._states = np.empty((joints, max(FIRST_ROOM, 2 * count)))
        self._states[:, :count] = roots.T
        self._parents = [-1] * count

    def __len__(self) -> int:
        return len(self._parents)

    def add(self, state: Array, parent: int) -> int:
        """Add a state, (n,), that was reached from another; return its index."""
        index = len(self._parents)
        if index == self._states.shape[1]:
            self._states = np.hstack([self._states, np.empty_like(self._states)])
        self._states[:, index] = state
        self._parents.append(parent)
        return index

    def state(self, index: int) -> Array:
        """Return a state, (n,)."""
        return self._states[:, index].copy()

    def nearest(self, state: Array) -> int:
        """Return the index of the state with the smallest Euclidean distance."""
        squares = self._states[:, : len(self._parents)] - state[:, None]
        np.multiply(squares, squares, out=squares)
        return int(squares.sum(axis=0).argmin())

    def path(self, index: int) -> Array:
        """Return the states from a root to one, (m, n)."""
        indices: list[int] = []
        while index >= 0:
            indices.append(index)
            index = self._parents[index]
        return self._states.T[indices[::-1]]


def rrt_connect(
    space: Space,
    start: Array,
    goals: Array,
    seed: Sequence[int],
    reach: float = REACH,
) -> Iterator[Array | None]:
    """Search for a path, one iteration at each step of the iterator.

    Args:
        space: where to search.
        start: where the path begins, (n,).
        goals: where it may end, (g, n).
        seed: seed of the random numbers.
        reach: longest move, in the joints' units.

    Yields:
        None after each iteration that found no path; then the path, (m, n), once.
    """
    from_start = growing = _StateTree(start[None, :])
    other = _StateTree(goals)
    for anywhere, change, part in _draws(space, seed):
        sample = anywhere
        if part < 1.0:
            near = growing.state(int(part * len(growing))) + change
            sample = np.minimum(np.maximum(near, space.lower), space.upper)
        grown = _explore(space, growing, sample, reach)
        if grown is not None:
            met = _follow(space, other, growing.state(grown), reach)
            if met is not None:
                yield _joined(growing.path(grown), other.path(met), growing is from_start)
                return
        yield None
        if len(other) <= len(growing):
            growing, other = other, growing


def _draws(space: Space, seed: Sequence[int]) -> Iterator[tuple[Array, Array, float]]:
    """Yield a state anywhere, a change, and which part of a tree to change; 1 and more for none."""
    random, shape = np.random.default_rng(seed), (BLOCK, len(space.lower))
    spread = SPREAD * (space.upper - space.lower)
    while True:
        states = random.uniform(space.lower, space.upper, shape)
        changes = random.standard_normal(shape) * spread
        yield from zip(states, changes, (random.random(BLOCK) / NEARBY).tolist(), strict=True)


def _explore(space: Space, tree: _StateTree, sample: Array, reach: float) -> int | None:
    """Grow a tree one move towards a sample; return the new state's index."""
    near = tree.nearest(sample)
    target = space.project(_towards(tree.state(near), sample, reach))
    return None if target is None else _grow(space, tree, near, target)[0]


def _follow(space: Space, tree: _StateTree, target: Array, reach: float) -> int | None:
    """Grow a tree towards a state as far as it gets; return the index where it arrives."""
    near = tree.nearest(target)
    while True:
        state = tree.state(near)
        if length(target - state) <= reach:
            grown, arrived = _grow(space, tree, near, target)
            return grown if arrived else None
        aim = space.project(_towards(state, target, reach))
        if aim is None or not _nearer(aim, state, target):
            return None
        grown, arrived = _grow(space, tree, near, aim)
        if grown is None or not arrived:
            return None
        near = grown


def _grow(space: Space, tree: _StateTree, parent: int, target: Array) -> tuple[int | None, bool]:
    """Move from a state of a tree; return the last new state, and whether it is the target."""
    states, arrived = space.advance(tree.state(parent), target)
    grown = None
    for state in states:
        grown = parent = tree.add(state, parent)
    return grown, arrived


def _towards(state: Array, target: Array, reach: float) -> Array:
    difference = target - state
    distance = length(difference)
    return target if distance <= reach else state + difference * (reach / distance)


def _nearer(a: Array, b: Array, target: Array) -> bool:
    return length(target - a) < 0.99 * length(target - b)


def _joined(explored: Array, followed: Array, forwards: bool) -> Array:
    """Join two branches that end at one state, in the direction from the start to a goal."""
    first, second = (explored, followed) if forwards else (followed, explored)
    return np.concatenate([first, second[-2::-1]])
