"""Which tree grows, and where to, in a space of which only the start's surroundings are closed."""

import numpy as np

from arm_planning.planners.rrt_connect import rrt_connect

START, GOAL = np.zeros(3), np.full(3, 0.9)


class Closed:
    """A space in which no move leaves or reaches the start; it notes all moves that are tried."""

    lower, upper = np.full(3, -1.0), np.full(3, 1.0)

    def __init__(self):
        self.moves = []

    def project(self, q):
        return q

    def advance(self, a, b):
        self.moves.append((a, b))
        arrived = bool(a.any() and b.any())
        return (b[None, :] if arrived else np.empty((0, 3))), arrived


def tried(iterations):
    space = Closed()
    search = rrt_connect(space, START, GOAL[None, :], (1,))
    assert [next(search) for _ in range(iterations)] == [None] * iterations
    return [b for a, b in space.moves if not a.any()]


def test_the_tree_that_is_smaller_gets_the_samples():
    assert len(tried(100)) > 95


def test_most_samples_are_near_to_the_tree_and_some_are_anywhere():
    far = np.abs(tried(400)).max(axis=1)
    assert 0.4 < np.median(far) < 0.6
    assert far.max() > 0.95
