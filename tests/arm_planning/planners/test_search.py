"""The suite's own planner on an arm in a plane."""

import contextlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from planar_arm import Blocked, PlanarArm, dense, planar_problem

from arm_description.urdf.robot import Box
from arm_node.rigid_transform import RigidTransform
from arm_planning.constraints.constraints import (
    MotionConstraints,
    OrientationConstraint,
    PositionConstraint,
)
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.planners.problem import Deadline, path_length
from arm_planning.planners.rrt_connect import rrt_connect
from arm_planning.planners.search import RrtConnectPlanner
from arm_planning.planners.space import space_of
from arm_planning.scene.objects import PlacedShape

POSTS = ((1.6, 0.9, 0.3), (1.6, -0.9, 0.3), (-0.5, 2.0, 0.4))
START, GOAL = [-1.2, 0.3, 0.2], [1.2, -0.3, -0.2]
PLANNER = RrtConnectPlanner()


def test_a_free_straight_path_is_returned_as_it_is():
    path = PLANNER.plan(planar_problem(PlanarArm(), START, GOAL))
    assert path.tolist() == [START, GOAL]


def test_a_path_around_obstacles_is_free_everywhere():
    arm = PlanarArm(POSTS)
    path = PLANNER.plan(planar_problem(arm, START, GOAL))
    assert path[0].tolist() == START
    assert path[-1].tolist() == GOAL
    assert all(map(arm.is_free, dense(path)))


def test_the_path_is_not_much_longer_than_needed():
    lengths = [
        path_length(PLANNER.plan(planar_problem(PlanarArm(POSTS), START, GOAL, seed=seed)))
        for seed in range(12)
    ]
    assert np.median(lengths) < 1.25 * min(lengths)


def test_the_same_seed_gives_the_same_path_and_another_seed_another():
    paths = [
        PLANNER.plan(planar_problem(PlanarArm(POSTS), START, GOAL, seed=seed)) for seed in (3, 3, 4)
    ]
    assert np.array_equal(paths[0], paths[1])
    assert not np.array_equal(paths[0], paths[2])


def test_the_path_ends_at_any_of_the_goals():
    blocked = [0.5, 0.0, 0.0]
    arm = PlanarArm(POSTS)
    path = PLANNER.plan(planar_problem(arm, START, [2.2, 0.0, 0.0], GOAL))
    assert path[-1].tolist() in ([2.2, 0.0, 0.0], GOAL)
    assert not arm.is_free(np.array(blocked))


def test_more_attempts_give_shorter_paths():
    one, five = (
        [
            path_length(
                PLANNER.plan(
                    planar_problem(PlanarArm(POSTS), START, GOAL, seed=seed, attempts=attempts)
                )
            )
            for seed in range(3)
        ]
        for attempts in (1, 5)
    )
    assert np.mean(five) < np.mean(one)


class SteppedClock:
    """A clock that moves on each time that it is read."""

    def __init__(self) -> None:
        self.readings = 0

    def __call__(self) -> float:
        self.readings += 1
        return float(self.readings)


class Doubter(PlanarArm):
    """Proves no path for a while, as where samples took one past an obstacle, and no move."""

    doubts = 60
    """More than the proofs of what one search finds, and fewer than those of three."""

    def prove(self, path: np.ndarray) -> Blocked | None:
        if len(path) == 2 and path[0].tolist() == path[1].tolist():
            return None
        self.doubts -= 1
        return super().prove(path) if self.doubts < 0 else Blocked(0, 0.5)

    def is_free_edge(self, a: np.ndarray, b: np.ndarray) -> bool:
        pytest.fail("a move was proved")


def test_another_path_is_searched_for_where_one_cannot_be_proved():
    arm = Doubter(POSTS)
    path = PLANNER.plan(planar_problem(arm, START, GOAL))
    assert arm.doubts < 0
    assert all(map(arm.is_free, dense(path)))


def test_a_search_ends_at_the_deadline():
    clock = SteppedClock()
    blocked = PlanarArm(((0.4, 0.6, 0.1),))
    problem = planar_problem(blocked, [0.0], [2.0], deadline=Deadline(200.0, clock))
    with pytest.raises(PlanningError, match="searching for a path; allow more time") as raised:
        PLANNER.plan(problem)
    assert raised.value.code == MoveItErrorCode.TIMED_OUT
    assert clock.readings == 201


def test_a_deadline_that_is_not_reached_changes_nothing():
    free, timed = (
        PLANNER.plan(planar_problem(PlanarArm(POSTS), START, GOAL, deadline=deadline))
        for deadline in (Deadline(), Deadline(1e6, SteppedClock()))
    )
    assert np.array_equal(free, timed)


def test_a_deadline_while_shortening_gives_no_half_shortened_path():
    clock = SteppedClock()
    PLANNER.plan(planar_problem(PlanarArm(POSTS), START, GOAL, deadline=Deadline(1e6, clock)))
    late = Deadline(clock.readings - 1.0, SteppedClock())
    with pytest.raises(PlanningError, match="the planning time ended"):
        PLANNER.plan(planar_problem(PlanarArm(POSTS), START, GOAL, deadline=late))


def test_attempts_that_come_too_late_lose_no_path_that_was_found():
    clock = SteppedClock()
    three = planar_problem(PlanarArm(POSTS), START, GOAL, attempts=3, deadline=Deadline(1e6, clock))
    best = PLANNER.plan(three)
    late = Deadline(clock.readings - 1.0, SteppedClock())
    path = PLANNER.plan(planar_problem(PlanarArm(POSTS), START, GOAL, attempts=3, deadline=late))
    assert path[-1].tolist() == GOAL
    assert all(map(PlanarArm(POSTS).is_free, dense(path)))
    assert path_length(path) >= path_length(best)


def test_a_start_in_collision_is_named():
    problem = planar_problem(PlanarArm(((1.0, 0.0, 0.2),)), [0.0, 0.0], [1.0, 0.0])
    with pytest.raises(
        PlanningError, match=r"the start is in collision: the arm with a disc, 0.20 m"
    ) as raised:
        PLANNER.plan(problem)
    assert raised.value.code == MoveItErrorCode.START_STATE_IN_COLLISION


LEVEL = MotionConstraints(
    orientations=(OrientationConstraint("l4", (0.0, 0.0, 0.0, 1.0), (0.1, 0.1, 0.1)),)
)
LEVEL_START, LEVEL_GOAL = [-1.0, 0.5, 0.5, 0.0], [1.0, -0.5, -0.5, 0.0]


def test_an_orientation_holds_on_the_whole_way_around_obstacles():
    arm = PlanarArm(((2.6, 0.0, 0.3),))
    problem = planar_problem(arm, LEVEL_START, LEVEL_GOAL, path=LEVEL)
    path = PLANNER.plan(problem)
    assert problem.path is not None
    assert all(map(problem.path.satisfied, dense(path)))
    assert all(map(arm.is_free, dense(path)))


def test_a_position_holds_on_the_whole_way():
    slot = PlacedShape(Box((0.2, 10.0, 1.0)), RigidTransform((2.0, 0.0, 0.0)))
    start = [0.5, 0.3, -1.0]
    arm = PlanarArm()
    x, y = arm.points(np.array(start))[-1]
    slot = PlacedShape(Box((0.2, 10.0, 1.0)), RigidTransform((x, 0.0, 0.0)))
    goal = [-0.5, -0.3, 1.0]
    path_constraints = MotionConstraints(
        positions=(PositionConstraint("l3", (0.0, 0.0, 0.0), (slot,)),)
    )
    problem = planar_problem(arm, start, goal, path=path_constraints)
    path = PLANNER.plan(problem)
    assert y > 0.1
    assert problem.path is not None
    assert all(map(problem.path.satisfied, dense(path)))


def test_a_start_that_violates_the_constraints_on_the_way_is_named():
    problem = planar_problem(PlanarArm(), [0.5, 0.0, 0.0, 0.0], LEVEL_GOAL, path=LEVEL)
    with pytest.raises(PlanningError, match="the start violates the path constraints: link 'l4'"):
        PLANNER.plan(problem)


disc = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(0.05, 0.5))


@settings(max_examples=15, deadline=None)
@given(discs=st.lists(disc, max_size=5), seed=st.integers(0, 99))
def test_whatever_path_comes_is_free(discs, seed):
    arm = PlanarArm(tuple(discs))
    ends = np.random.default_rng(seed).uniform(-2.9, 2.9, (2, 3))
    problem = planar_problem(
        arm, ends[0].tolist(), ends[1].tolist(), deadline=Deadline(200.0, SteppedClock())
    )
    if not arm.is_free(ends[0]):
        return
    with contextlib.suppress(PlanningError):
        path = PLANNER.plan(problem)
        assert all(map(arm.is_free, dense(path)))
        assert (np.abs(path) <= 3.0).all()


@pytest.mark.parametrize("reach", [0.3, 4.0])
def test_no_move_of_a_tree_is_longer_than_its_reach(reach):
    problem = planar_problem(PlanarArm(POSTS), START, GOAL)
    goals = np.array([GOAL])
    search = rrt_connect(space_of(problem, goals), np.array(START), goals, (1,), reach)
    path = next(path for path in search if path is not None)
    longest = np.linalg.norm(np.diff(path, axis=0), axis=1).max()
    assert longest <= reach + 1e-9
    assert longest > 0.3 - 1e-9
