"""Paths that samples let pass, and that touch something all the same."""

import numpy as np
from planar_arm import PlanarArm, dense, planar_problem

from arm_planning.planners.mend import mend
from arm_planning.planners.problem import NO_DEADLINE
from arm_planning.planners.search import RrtConnectPlanner
from arm_planning.planners.space import SampledSpace

LIMITS = np.array([-3.0, -3.0]), np.array([3.0, 3.0])
START, GOAL = np.array([-0.2, 0.0]), np.array([0.7, 0.0])
NEEDLE = PlanarArm(((1.918, 0.5878, 0.008),))
"""Only the arm that is stretched out touches it, for less than the distance of two samples."""


def test_samples_miss_what_the_proof_finds():
    assert SampledSpace(NEEDLE, *LIMITS).connect(START, GOAL) is not None
    assert not NEEDLE.is_free_edge(START, GOAL)


def test_a_path_is_bent_past_what_it_touches():
    space = SampledSpace(NEEDLE, *LIMITS)
    path = mend(np.array([START, GOAL]), space, NEEDLE, (1,), NO_DEADLINE, [])
    assert path is not None
    assert len(path) == 3
    assert NEEDLE.prove(path) is None
    assert all(map(NEEDLE.is_free, dense(path)))


def test_a_way_point_that_touches_is_moved():
    space = SampledSpace(NEEDLE, *LIMITS)
    touching = np.array([np.arctan2(0.5878, 1.918), 0.0])
    assert not NEEDLE.is_free(touching)
    path = mend(np.array([START, touching, GOAL]), space, NEEDLE, (1,), NO_DEADLINE, [])
    assert path is not None
    assert NEEDLE.prove(path) is None
    assert np.array_equal(path[[0, -1]], [START, GOAL])


def test_a_path_that_is_free_stays_as_it_is():
    arm = PlanarArm()
    path = np.array([START, GOAL])
    kept = mend(path, SampledSpace(arm, *LIMITS), arm, (1,), NO_DEADLINE, [])
    assert np.array_equal(kept, path)


def test_what_cannot_be_bent_is_none_and_is_not_tried_again():
    wall = PlanarArm(((1.5, 0.6, 0.3),))
    space, stuck = SampledSpace(wall, *LIMITS), []
    assert mend(np.array([START, GOAL]), space, wall, (1,), NO_DEADLINE, stuck) is None
    assert len(stuck) == 1
    proofs = []

    class Counting(PlanarArm):
        def prove(self, path):
            proofs.append(path)
            return super().prove(path)

    again = Counting(((1.5, 0.6, 0.3),))
    assert mend(np.array([START, GOAL]), space, again, (1,), NO_DEADLINE, stuck) is None
    assert len(proofs) == 1
    assert len(stuck) == 1


def test_the_planner_returns_the_bent_path():
    problem = planar_problem(NEEDLE, START.tolist(), GOAL.tolist())
    path = RrtConnectPlanner().plan(problem)
    assert NEEDLE.prove(path) is None
