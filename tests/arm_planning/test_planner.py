"""The face of planning without ROS, on the myCobot."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from collision_judge import Judge
from planning_models import MYCOBOT

from arm_description import expand_xacro
from arm_description.resources import ResourceFinder
from arm_node.rigid_transform import RigidTransform
from arm_planning.constraints.constraints import joint_goal, pose_goal
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.planner import Planner
from arm_planning.request import PlanRequest
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.shapes import Box

BENT = (0.0, -0.7, -1.0, 0.2, 0.0, 0.0)
TURN = "link1_to_link2"


@pytest.fixture(scope="module")
def made() -> Planner:
    finder = ResourceFinder()
    return Planner.of_urdf(expand_xacro(finder.find(MYCOBOT)), resources=finder)


@pytest.fixture
def planner(made) -> Planner:
    """A planner with the arm bent, and nothing around it."""
    bent = dict(zip(made.model.group("arm").joints, BENT, strict=True))
    made.scene = replace(made.scene, positions={**made.scene.positions, **bent}, objects={})
    return made


def put_floor(planner: Planner, below_m: float) -> RigidTransform:
    """Put a plate below the flange; return the pose of the flange at its centre."""
    flange = planner.link_pose("link6_flange")
    x, y, z = flange.position
    centre = RigidTransform((x, y, z - below_m))
    plate = CollisionObject("floor", centre, (PlacedShape(Box((0.3, 0.3, 0.02))),))
    planner.scene = replace(planner.scene, objects={"floor": plate})
    return RigidTransform(centre.position, flange.rotation)


def test_a_straight_path_from_a_start_in_collision_stays_there_and_says_why(planner):
    end = put_floor(planner, 0.08)
    assert planner.contacts("arm")
    found = planner.cartesian_path("arm", [end], max_step_m=0.005, link="link6_flange")
    assert found.fraction == 0.0
    assert len(found.trajectory.positions) == 1
    assert "floor" in found.stopped


def test_a_plan_from_a_start_in_collision_names_what_touches(planner):
    put_floor(planner, 0.08)
    with pytest.raises(PlanningError, match="floor") as caught:
        planner.move("arm", {TURN: 0.5})
    assert caught.value.code is MoveItErrorCode.START_STATE_IN_COLLISION


def test_a_start_slightly_outside_is_moved_inside_and_said(planner):
    limit = planner.model.group("arm").limits[0].upper
    goal = planner.plan(PlanRequest("arm", (), start={TURN: limit + 0.02}))
    assert goal.code is MoveItErrorCode.START_STATE_INVALID
    planner.scene = replace(
        planner.scene, positions={**planner.scene.positions, TURN: limit + 0.005}
    )
    trajectory = planner.move("arm", {TURN: 1.0})
    assert trajectory.positions[0, 0] == limit
    assert trajectory.positions[-1, 0] == pytest.approx(1.0, abs=2e-4)


def test_a_goal_beyond_a_limit_is_moved_to_it_and_said(planner):
    limit = planner.model.group("arm").limits[0].upper
    response = planner.plan(PlanRequest("arm", (joint_goal({TURN: 9.0}),)))
    assert response.trajectory.positions[-1, 0] == pytest.approx(limit, abs=1e-6)
    assert response.message == f"the goal of joint '{TURN}', 9, is beyond its limit; 2.88 is used"


def test_a_thing_put_into_the_way_blocks_only_what_is_ahead(planner):
    trajectory = planner.move("arm", {TURN: 1.0})
    assert planner.blocked_ahead(trajectory, 0.0) == ""
    middle = trajectory.positions[len(trajectory.positions) // 2]
    joints = dict(zip(trajectory.joints, middle.tolist(), strict=True))
    there = replace(planner.scene, positions={**planner.scene.positions, **joints})
    centre = RigidTransform(planner.link_pose("link6_flange", there).position)
    thing = CollisionObject("thing", centre, (PlacedShape(Box((0.02, 0.02, 0.02))),))
    blocked = replace(planner.scene, objects={"thing": thing})
    assert "thing" in planner.blocked_ahead(trajectory, 0.0, blocked)
    assert planner.blocked_ahead(trajectory, trajectory.duration_s, blocked) == ""


def test_the_line_of_pilz_does_not_lead_through_a_thing(planner):
    end = put_floor(planner, 0.08)
    floor = planner.scene.objects["floor"]
    x, y, z = floor.pose.position
    low = replace(floor, pose=RigidTransform((x, y, z - 0.06)))
    planner.scene = replace(planner.scene, objects={"floor": low})
    assert not planner.contacts("arm")
    goal = (pose_goal("link6_flange", end),)
    response = planner.plan(
        PlanRequest("arm", goal, pipeline="pilz_industrial_motion_planner", planner="LIN")
    )
    assert response.trajectory is None
    assert "floor" in response.message


@pytest.mark.parametrize("seed", range(4))
def test_every_state_of_a_plan_among_random_boxes_is_free(planner, seed):
    random = np.random.default_rng(seed)
    arm = planner.model.group("arm").joints
    goal = dict(zip(arm, (1.5, -0.5, -1.2, 0.4, 0.3, 0.2), strict=True))
    crowded = planner.scene
    while len(crowded.objects) < 8:
        place = RigidTransform(tuple(random.uniform((-0.3, -0.3, 0.0), (0.3, 0.3, 0.4)).tolist()))
        name = f"box{len(crowded.objects)}"
        thing = CollisionObject(name, place, (PlacedShape(Box((0.05, 0.05, 0.05))),))
        more = replace(crowded, objects={**crowded.objects, name: thing})
        at_goal = replace(more, positions={**more.positions, **goal})
        if not planner.contacts("arm", more) and not planner.contacts("arm", at_goal):
            crowded = more
    request = PlanRequest("arm", (joint_goal(goal),), seed=seed, allowed_time_s=20.0)
    found, again = planner.plan(request, crowded), planner.plan(request, crowded)
    assert found.trajectory is not None, found.message
    assert again.trajectory is not None, again.message
    path = found.trajectory.positions
    assert path.tobytes() == again.trajectory.positions.tobytes()
    judge = Judge(planner.model, crowded)
    for a, b in pairwise(path):
        for fraction in np.linspace(0.0, 1.0, 2 + int(np.abs(b - a).max() / 0.01)):
            q = dict(zip(arm, (a + fraction * (b - a)).tolist(), strict=True))
            assert judge.is_free({**crowded.positions, **q})
