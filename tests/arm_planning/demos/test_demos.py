"""The demonstrations of the task constructor, each planned without ROS."""

from dataclasses import replace

import numpy as np
import pytest
from collision_judge import Judge

from arm_description import expand_xacro
from arm_description.resources import ResourceFinder
from arm_description.urdf.parser import parse_urdf
from arm_planning.demos.all_demos import DEMOS
from arm_planning.demos.pick_place import OBJECT, PLACE
from arm_planning.mtc_demo_node import CONFIGURATION, main
from arm_planning.planner import Planner
from arm_planning.planners.pilz.cartesian_limits import CartesianLimits
from arm_planning.robot.build import planning_model
from arm_planning.robot.srdf import parse_srdf
from arm_planning.scene.allowed_collisions import allowed_collisions
from arm_planning.scene.scene import PlanningScene
from arm_planning.tasks.solution import Solution

URDF = "package://mycobot_description/urdf/robots/mycobot_280.urdf.xacro"


@pytest.fixture(scope="module")
def planner() -> Planner:
    finder = ResourceFinder()
    robot = parse_urdf(expand_xacro(finder.find(URDF)))
    srdf = parse_srdf((finder.find(CONFIGURATION) / "mycobot_280.srdf").read_text(), robot)
    model = planning_model(robot, srdf)
    scene = PlanningScene(dict.fromkeys(model.joints, 0.0), allowed=allowed_collisions(srdf))
    return Planner(model, scene, resources=finder, tip_limits=CartesianLimits())


def plan(planner: Planner, name: str) -> tuple[Solution, ...]:
    """Plan a demonstration; all its motions follow one another, and are free by another judge."""
    demo = DEMOS[name]
    planner.scene = replace(planner.scene, objects={each.id: each for each in demo.objects})
    task = demo.task(planner.model)
    found = task.plan(planner, max_solutions=demo.max_solutions, allowed_time_s=150.0)
    assert [each.cost for each in found] == sorted(each.cost for each in found)
    for solution in found:
        check(planner, solution)
    return found


def check(planner: Planner, solution: Solution) -> None:
    position = solution.start.positions
    for step in solution.steps:
        assert step.start.positions == pytest.approx(position, abs=1e-6), step.stage
        position = step.end.positions
        if step.trajectory is None:
            continue
        judge = Judge(planner.model, step.start)
        for q in step.trajectory.positions.tolist():
            state = dict(zip(step.trajectory.joints, q, strict=True))
            assert judge.is_free({**step.start.positions, **state}), step.stage


def test_the_cylinder_is_put_down_at_its_place(planner):
    (found,) = plan(planner, "pick_place_demo")
    placed = found.end.objects[OBJECT].pose
    assert placed.position == pytest.approx(PLACE.position, abs=1e-4)
    assert found.named("move to place").start.attached
    assert not found.end.attached
    assert found.end.positions == pytest.approx(dict.fromkeys(planner.model.joints, 0.0), abs=1e-6)


def test_straight_motions_follow_one_another_and_lead_back(planner):
    (found,) = plan(planner, "cartesian")
    places = {
        name: np.array(planner.link_pose("gripper_base", found.named(name).end).position)
        for name in ("ready", "x +0.05", "y -0.02", "rz -18°", "final state")
    }
    assert places["x +0.05"] - places["ready"] == pytest.approx((0.05, 0.0, 0.0), abs=1e-4)
    assert places["y -0.02"] - places["x +0.05"] == pytest.approx((0.0, -0.02, 0.0), abs=1e-4)
    assert places["rz -18°"] == pytest.approx(places["y -0.02"], abs=1e-4)
    assert places["final state"] == pytest.approx(places["ready"], abs=1e-4)


def test_a_module_is_used_five_times(planner):
    (found,) = plan(planner, "modular")
    assert [step.stage for step in found.steps].count("move to ready") == 5


def test_each_start_is_left_by_the_first_planner_that_can(planner):
    found = plan(planner, "fallbacks_move_to")
    assert {(way.stage, by.stage) for way, by in (each.steps for each in found)} == {
        ("near", "Cartesian path"),
        ("bent the other way", "Pilz PTP"),
        ("behind the box", "OMPL"),
    }


def test_joint_positions_far_from_the_sphere_come_first(planner):
    found = plan(planner, "ik_clearance_cost")
    assert len(found) > 1
    costs = [each.named("compute IK").cost for each in found]
    assert costs[0] < costs[-1] / 2.0


def test_each_cost_counts_the_same_way(planner):
    found = plan(planner, "alternative_path_costs")
    assert {each.steps[1].stage: each.cost for each in found} == {
        "path length": pytest.approx(np.pi, abs=1e-3),
        "trajectory duration": pytest.approx(found[-1].steps[1].trajectory.duration_s),
        "link6_flange motion": pytest.approx(0.41, abs=0.02),
        "link3 motion": pytest.approx(0.0, abs=1e-9),
    }


def test_an_unknown_demonstration_is_told_those_that_there_are(capsys):
    assert main(["mtc_demo", "cartesien"]) == 2
    assert "'cartesian'" in capsys.readouterr().err
    assert main(["mtc_demo"]) == 2
