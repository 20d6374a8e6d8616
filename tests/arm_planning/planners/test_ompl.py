"""OMPL's planners on an arm in a plane."""

import numpy as np
import pytest
from planar_arm import PlanarArm, dense, planar_problem

from arm_planning.constraints.constraints import JointConstraint, MotionConstraints
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.planners.problem import Deadline
from arm_planning.planners.registry import planner_for, planner_ids, planner_parameters

pytest.importorskip("ompl", reason="comes with the extra ompl")

POSTS = ((1.6, 0.9, 0.3), (-0.5, 2.0, 0.4))
START, GOAL = [-0.3, 0.3], [1.2, -0.3]


def test_the_wheel_has_planners_beside_the_own_one():
    assert {"RRTConnect", "RRTstar", "KPIECE1", "BITstar"} <= set(planner_ids())


@pytest.mark.parametrize("planner_id", planner_ids()[1:])
def test_each_finds_a_free_path_and_the_same_for_the_same_seed(planner_id):
    arm = PlanarArm(POSTS)
    assert not arm.is_free_edge(np.array(START), np.array(GOAL))
    paths = [
        planner_for(planner_id).plan(planar_problem(arm, START, GOAL, seed=4)) for _ in range(2)
    ]
    assert np.array_equal(*paths)
    assert paths[0][0].tolist() == START
    assert paths[0][-1] == pytest.approx(np.array(GOAL))
    assert all(map(arm.is_free, dense(paths[0])))


def test_one_of_several_goals_is_reached():
    problem = planar_problem(PlanarArm(POSTS), START, [2.9, 2.0], GOAL)
    path = planner_for("RRT").plan(problem)
    assert path[-1].tolist() in (pytest.approx([2.9, 2.0]), pytest.approx(GOAL))


def test_a_search_ends_at_the_deadline():
    readings = iter(range(1000))
    late = Deadline(50.0, lambda: float(next(readings)))
    problem = planar_problem(PlanarArm(((0.4, 0.6, 0.1),)), [0.0], [2.0], deadline=late)
    with pytest.raises(PlanningError, match="searching for a path; allow more time"):
        planner_for("KPIECE1").plan(problem)


def test_an_error_of_the_checker_comes_through():
    class Broken(PlanarArm):
        def is_free_edge(self, a, b):
            if self.checks > 20:
                raise PlanningError(MoveItErrorCode.CRASH, "the checker broke")
            return super().is_free_edge(a, b)

    with pytest.raises(PlanningError, match="the checker broke"):
        planner_for("RRT").plan(planar_problem(Broken(POSTS), START, GOAL))


def test_constraints_on_the_way_are_refused_with_the_planner_that_takes_them():
    path = MotionConstraints((JointConstraint("j0", 0.0, 3.0, 3.0),))
    with pytest.raises(PlanningError, match="takes no path constraints; the planner RRTConnect"):
        planner_for("RRT").plan(planar_problem(PlanarArm(), START, GOAL, path=path))


@pytest.mark.parametrize("planner_id", ["RRT", "KPIECE1", "LBKPIECE1"])
def test_a_planner_takes_the_parameters_that_it_is_said_to_have(planner_id):
    values = {name: 0.4 for name in planner_parameters(planner_id)}
    assert set(values) <= {"range", "goal_bias"}
    problem = planar_problem(PlanarArm(POSTS), START, GOAL, seed=4)
    path = planner_for(planner_id, values).plan(problem)
    assert path[-1] == pytest.approx(np.array(GOAL))


def test_a_range_acts():
    arms = [PlanarArm(POSTS), PlanarArm(POSTS)]
    for arm, reach in zip(arms, (0.05, 2.0), strict=True):
        planner_for("RRT", {"range": reach}).plan(planar_problem(arm, START, GOAL, seed=4))
    assert arms[0].checks > arms[1].checks
