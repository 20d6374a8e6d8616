"""Goal states from constraints, and why there are none."""

import math

import numpy as np
import pytest
from planar_arm import PlanarArm, planar_model

from arm_description.urdf.robot import Box, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.constraints.constraints import (
    JointConstraint,
    MotionConstraints,
    OrientationConstraint,
    PositionConstraint,
)
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.planners.goals import GoalSampler
from arm_planning.planners.problem import Deadline
from arm_planning.scene.objects import PlacedShape

MODEL = planar_model(3)
GROUP = MODEL.group("arm")
START = np.array([0.3, -0.2, 0.1])


def inverse(
    link: str, pose: np.ndarray, seed: np.ndarray, *, most: int, random_seed: int, any_turn: bool
) -> list[np.ndarray]:
    """Both solutions of three links of 1 m for the pose of the tip, the nearer one first."""
    assert link == "l3"
    turn = math.atan2(pose[1, 0], pose[0, 0])
    x, y = pose[:2, 3] - [math.cos(turn), math.sin(turn)]
    cosine = (x * x + y * y - 2.0) / 2.0
    if abs(cosine) > 1.0:
        raise PlanningError(MoveItErrorCode.NO_IK_SOLUTION, "the nearest pose is 12 mm away")
    found = []
    for elbow in (math.acos(cosine), -math.acos(cosine)):
        first = math.atan2(y, x) - math.atan2(math.sin(elbow), 1.0 + math.cos(elbow))
        q = np.array([first, elbow, math.remainder(turn - first - elbow, 2.0 * math.pi)])
        found.append(q)
    return sorted(found, key=lambda q: float(np.linalg.norm(q - seed)))[:most]


def sampler(*goals: MotionConstraints, arm: PlanarArm | None = None, **options) -> GoalSampler:
    arm = arm or PlanarArm()
    settings = {
        "path": MotionConstraints(),
        "positions": {},
        "inverse": inverse,
        "start": START,
        **options,
    }
    return GoalSampler(goals, model=MODEL, group=GROUP, pose=arm.pose, checker=arm, **settings)


def joints(*positions: float, tolerance: float = 1e-4) -> MotionConstraints:
    return MotionConstraints(
        tuple(
            JointConstraint(name, position, tolerance, tolerance)
            for name, position in zip(GROUP.joints, positions, strict=False)
        )
    )


def pose_goal(q: list[float], *, turn: float = 1e-3, radius: float = 1e-4) -> MotionConstraints:
    pose = PlanarArm().pose(np.array(q), "l3")
    half = math.atan2(pose[1, 0], pose[0, 0]) / 2.0
    region = PlacedShape(Sphere(radius), RigidTransform(tuple(pose[:3, 3].tolist())))
    return MotionConstraints(
        positions=(PositionConstraint("l3", (0.0, 0.0, 0.0), (region,)),),
        orientations=(
            OrientationConstraint("l3", (0.0, 0.0, math.sin(half), math.cos(half)), (turn,) * 3),
        ),
    )


def code_of(goals: GoalSampler) -> tuple[MoveItErrorCode, str]:
    with pytest.raises(PlanningError) as raised:
        goals.all()
    return raised.value.code, str(raised.value)


def test_a_goal_of_joints_is_the_goal_state():
    goals = sampler(joints(1.0, -1.0, 0.5))
    assert [q.tolist() for q in goals.nearest()] == [[1.0, -1.0, 0.5]]
    assert [q.tolist() for q in goals.all()] == [[1.0, -1.0, 0.5]]


def test_joints_that_a_goal_leaves_open_stay_at_the_start():
    assert sampler(joints(1.0)).all()[0].tolist() == [1.0, -0.2, 0.1]


def test_a_goal_in_collision_gives_way_to_others_in_its_tolerance():
    arm = PlanarArm(((0.0, 1.0, 0.2),))
    goals = sampler(joints(math.pi / 2.0, 0.0, 0.0, tolerance=0.6), arm=arm)
    assert goals.nearest() == ()
    found = goals.all()
    assert found
    assert all(map(arm.is_free, found))
    assert all(np.abs(q - [math.pi / 2.0, 0.0, 0.0]).max() <= 0.6 for q in found)


def test_a_goal_of_a_pose_has_all_solutions_near_ones_first():
    found = sampler(pose_goal([0.5, 0.8, 0.3])).all()
    assert len(found) == 2
    distances = [np.linalg.norm(q - START) for q in found]
    assert distances == sorted(distances)
    assert any(q == pytest.approx([0.5, 0.8, 0.3], abs=1e-6) for q in found)


def test_solutions_in_collision_are_left_out():
    elbow_up = [0.5, 0.8, 0.3]
    arm = PlanarArm(((math.cos(0.5), math.sin(0.5), 0.1),))
    found = sampler(pose_goal(elbow_up), arm=arm).all()
    assert len(found) == 1
    assert found[0][1] == pytest.approx(-0.8)


def test_a_wide_orientation_gives_further_poses():
    narrow, wide = (sampler(pose_goal([0.5, 0.8, 0.3], turn=turn)).all() for turn in (1e-3, 1.0))
    assert len(wide) > len(narrow)


def test_constraints_on_a_pose_and_on_joints_hold_together():
    below = JointConstraint("j1", -1.5, 1.5, 1.5)
    goal = pose_goal([0.5, 0.8, 0.3])
    both = MotionConstraints((below,), goal.positions, goal.orientations)
    assert [float(q[1]) for q in sampler(both).all()] == [pytest.approx(-0.8)]


def test_alternatives_are_sorted_together():
    found = sampler(joints(2.0, 0.0, 0.0), joints(0.4, 0.0, 0.0)).all()
    assert [q[0] for q in found] == [0.4, 2.0]


def test_the_same_seed_gives_the_same_goal_states():
    first, again = (sampler(pose_goal([0.5, 0.8, 0.3], turn=1.0), seed=5).all() for _ in range(2))
    assert np.array_equal(first, again)


@pytest.mark.parametrize("goal", [joints(1.57, 0.0, 0.0), pose_goal([1.57, 0.0, 0.0])])
def test_a_goal_in_collision_names_what_touches(goal):
    code, sentence = code_of(sampler(goal, arm=PlanarArm(((0.0, 1.0, 0.2),))))
    assert code == MoveItErrorCode.GOAL_IN_COLLISION
    assert sentence.startswith("goal is in collision: the arm with a disc, 0.")


def test_a_goal_out_of_reach_says_so():
    region = PlacedShape(Sphere(1e-3), RigidTransform((5.0, 0.0, 0.0)))
    goal = MotionConstraints(positions=(PositionConstraint("l3", (0.0, 0.0, 0.0), (region,)),))
    code, sentence = code_of(sampler(goal))
    assert code == MoveItErrorCode.NO_IK_SOLUTION
    assert sentence == "goal is out of reach: the nearest pose is 12 mm away"


def test_when_the_time_ends_first_a_goal_out_of_reach_still_says_so():
    region = PlacedShape(Sphere(1e-3), RigidTransform((5.0, 0.0, 0.0)))
    goal = MotionConstraints(positions=(PositionConstraint("l3", (0.0, 0.0, 0.0), (region,)),))
    ticks = iter([0.0, 0.0, 2.0])
    code, sentence = code_of(sampler(goal, deadline=Deadline(1.0, lambda: next(ticks))))
    assert code == MoveItErrorCode.NO_IK_SOLUTION
    assert sentence.startswith("goal is out of reach: the nearest pose is 12 mm away; the planning")


def test_a_goal_that_violates_the_constraints_on_the_way_says_so():
    region = PlacedShape(Box((1.0, 1.0, 1.0)), RigidTransform((2.5, 0.0, 0.0)))
    inside = MotionConstraints(positions=(PositionConstraint("l3", (0.0, 0.0, 0.0), (region,)),))
    code, sentence = code_of(sampler(joints(2.0, 0.0, 0.0), path=inside))
    assert code == MoveItErrorCode.GOAL_VIOLATES_PATH_CONSTRAINTS
    assert sentence.startswith("goal violates the path constraints: link 'l3' is")


def test_solutions_beyond_a_limit_are_left_out_and_named():
    code, sentence = code_of(sampler(pose_goal([0.0, 3.05, 0.0])))
    assert code == MoveItErrorCode.GOAL_STATE_INVALID
    assert sentence == ("goal is outside of the limits: joint 'j1' at 3.05 has the limits -3 and 3")


def test_contradictory_constraints_name_the_one_that_fails():
    goal = pose_goal([0.5, 0.8, 0.3])
    both = MotionConstraints(
        (JointConstraint("j0", 2.0, 0.1, 0.1),), goal.positions, goal.orientations
    )
    code, sentence = code_of(sampler(both))
    assert code == MoveItErrorCode.GOAL_CONSTRAINTS_VIOLATED
    assert sentence.startswith("goal cannot be met: joint 'j0' is at")


def test_a_request_without_a_goal_says_what_it_needs():
    for goals in (sampler(), sampler(MotionConstraints())):
        code, sentence = code_of(goals)
        assert code == MoveItErrorCode.INVALID_GOAL_CONSTRAINTS
        assert "it needs constraints on joints, positions or orientations" in sentence


def test_a_group_without_inverse_kinematics_says_so():
    code, sentence = code_of(sampler(pose_goal([0.5, 0.8, 0.3]), inverse=None))
    assert code == MoveItErrorCode.NO_IK_SOLUTION
    assert sentence == "group 'arm' has no inverse kinematics; give a goal of its joints"
