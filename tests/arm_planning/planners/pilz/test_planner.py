import dataclasses

import numpy as np
import pytest
from pilz_arm import (
    KINEMATICS,
    MODEL,
    NAMES,
    READY,
    START,
    TIP,
    asked,
    auxiliary,
    joint_goal,
    pose_goal,
    tip_offsets,
)

from arm_node.rigid_transform import RigidTransform, quaternion_product
from arm_planning.constraints.constraints import MotionConstraints
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.planners.pilz.cartesian_limits import CartesianLimits
from arm_planning.planners.pilz.planner import PilzPlanner
from arm_planning.planners.pose_line import PoseLine
from arm_planning.request import PlanRequest
from arm_planning.timing.driven_spline import chord_deviation, limit_violation

SLOW = CartesianLimits(max_trans_vel=0.05, max_trans_acc=0.2, max_trans_dec=-0.2)
PLANNER = PilzPlanner(MODEL, SLOW)
LIMITS = MODEL.group("arm").limits


def refused(code, request, state=READY):
    with pytest.raises(PlanningError) as error:
        PLANNER.plan(request, state)
    assert error.value.code is code
    return str(error.value)


def test_ptp_moves_all_joints_on_a_straight_line_within_their_limits():
    goal = START + np.array((0.5, -0.1, 0.2, 0.0, 0.3, -0.4))
    found = PLANNER.plan(asked("PTP", joint_goal(*goal)), READY)
    assert found.positions[0] == pytest.approx(START)
    assert found.positions[-1] == pytest.approx(goal)
    assert chord_deviation(found).max() < 1e-9
    assert limit_violation(found, LIMITS) == ""


def test_ptp_takes_as_long_as_its_slowest_joint():
    found = PLANNER.plan(asked("", joint_goal(START[0] + 0.75, names=("j1",))), READY)
    # Half of the way at 3 rad/s^2, the other half to stop.
    assert found.duration_s == pytest.approx(1.0, rel=0.01)


def test_ptp_to_a_pose_reaches_it():
    found = PLANNER.plan(asked("PTP", pose_goal((0.0, 0.05, -0.03))), READY)
    off = PoseLine(KINEMATICS.tip_pose(found.positions[-1]), TIP)
    assert off.length_m == pytest.approx(np.hypot(0.05, 0.03), abs=1e-5)
    assert off.angle_rad < 1e-4


def test_ptp_to_a_pose_reaches_it_where_it_is_free():
    usual = PLANNER.plan(asked("PTP", pose_goal((0.0, 0.05, 0.0))), READY).positions[-1]
    found = PLANNER.plan(
        asked("PTP", pose_goal((0.0, 0.05, 0.0))),
        READY,
        lambda q: bool(np.abs(q - usual).max() > 0.1),
    )
    assert np.abs(found.positions[-1] - usual).max() > 0.1


def test_lin_moves_the_tip_on_a_line_as_fast_as_its_limits_allow():
    found = PLANNER.plan(asked("LIN", pose_goal((0.0, 0.1, 0.0))), READY)
    # 0.1 / v + v / a, if the joints can follow.
    assert found.duration_s == pytest.approx(0.1 / 0.05 + 0.05 / 0.2, rel=0.02)
    way = tip_offsets(found)
    assert np.abs(way[:, [0, 2]]).max() < 1.5e-4
    assert way[-1] == pytest.approx([0.0, 0.1, 0.0], abs=1e-5)
    speeds = np.diff(way[:, 1]) / (found.duration_s / 299)
    assert speeds.max() == pytest.approx(0.05, rel=0.01)
    assert speeds.min() > -1e-6


def test_lin_scales_its_speed():
    found = PLANNER.plan(
        asked("LIN", pose_goal((0.0, 0.1, 0.0)), velocity_scaling=0.5, acceleration_scaling=0.5),
        READY,
    )
    assert found.duration_s == pytest.approx(0.1 / 0.025 + 0.025 / 0.1, rel=0.02)


def test_lin_turns_the_tip_about_one_axis():
    turned = quaternion_product((0.0, 0.0, np.sin(0.2), np.cos(0.2)), TIP.rotation)
    found = PLANNER.plan(asked("LIN", pose_goal((0.0, 0.0, 0.0), turned)), READY)
    assert np.abs(tip_offsets(found)).max() < 2e-4
    line = PoseLine(TIP, RigidTransform(TIP.position, turned))
    for q in found.positions:
        pose = KINEMATICS.tip_pose(q)
        passed = PoseLine(TIP, pose).angle_rad / 0.4
        assert PoseLine(line.at(passed), pose).angle_rad < 1.5e-3
    assert passed == pytest.approx(1.0, abs=1e-4)


def test_lin_slows_down_where_a_joint_could_not_follow():
    hasty = PilzPlanner(MODEL, CartesianLimits(max_trans_vel=9.0, max_trans_acc=90.0))
    found = hasty.plan(asked("LIN", pose_goal((0.0, 0.2, 0.0))), READY)
    assert limit_violation(found, LIMITS) == ""
    assert np.abs(tip_offsets(found)[:, [0, 2]]).max() < 1.5e-4


def test_lin_says_where_it_stops():
    sentence = refused(MoveItErrorCode.NO_IK_SOLUTION, asked("LIN", pose_goal((0.0, 2.0, 0.0))))
    assert "LIN stops" in sentence
    assert "of 2.000 m along its path" in sentence


def test_lin_to_where_it_is_already_is_one_point():
    found = PLANNER.plan(asked("LIN", joint_goal(*START)), READY)
    assert found.duration_s == 0.0
    assert found.positions == pytest.approx(START[None])


def test_circ_goes_through_its_interim_point():
    found = PLANNER.plan(
        asked("CIRC", pose_goal((0.0, 0.1, 0.0)), path=auxiliary("interim", (0.0, 0.05, 0.05))),
        READY,
    )
    way = tip_offsets(found)
    assert np.linalg.norm(way - (0.0, 0.05, 0.0), axis=1) == pytest.approx(0.05, abs=2e-4)
    assert way[:, 2].max() == pytest.approx(0.05, abs=2e-4)
    assert found.duration_s == pytest.approx(0.05 * np.pi / 0.05 + 0.25, rel=0.02)


def test_circ_goes_the_short_way_about_its_centre():
    found = PLANNER.plan(
        asked("CIRC", pose_goal((0.0, 0.05, -0.05)), path=auxiliary("center", (0.0, 0.05, 0.0))),
        READY,
    )
    way = tip_offsets(found)
    assert np.linalg.norm(way - (0.0, 0.05, 0.0), axis=1) == pytest.approx(0.05, abs=2e-4)
    assert way[:, 2].max() < 1e-4


CIRC = {"goal": pose_goal((0.0, 0.1, 0.0))}


@pytest.mark.parametrize(
    ("path", "sentence"),
    [
        (MotionConstraints(), 'No path constraint named "interim" or "center" found'),
        (auxiliary("interim", (0.0, 0.05, 0.0)), "are on a line"),
        (auxiliary("center", (0.0, 0.05, 0.0)), "give an interim point instead"),
        (auxiliary("center", (0.0, 0.02, 0.0)), "0.0200 m from the start and 0.0800 m from"),
        (MotionConstraints(name="center"), "exactly one position constraint"),
    ],
)
def test_circles_that_do_not_exist(path, sentence):
    request = asked("CIRC", CIRC["goal"], path=path)
    assert sentence in refused(MoveItErrorCode.INVALID_MOTION_PLAN, request)


def test_circ_refuses_a_point_of_an_unknown_link():
    request = asked("CIRC", CIRC["goal"], path=auxiliary("center", (0.0, 0.05, 0.0), link="l9"))
    assert "no link 'l9'" in refused(MoveItErrorCode.INVALID_LINK_NAME, request)


@pytest.mark.parametrize(
    ("request_", "code", "sentence"),
    [
        (asked("PTX", joint_goal(*START)), "PLANNING_FAILED", "there are PTP, LIN, CIRC"),
        (
            asked("PTP", joint_goal(*START), velocity_scaling=0.0),
            "INVALID_MOTION_PLAN",
            "Velocity scaling not in range [0.0001, 1], actual value is: 0",
        ),
        (
            asked("PTP", joint_goal(*START), acceleration_scaling=1.1),
            "INVALID_MOTION_PLAN",
            "Acceleration scaling not in range",
        ),
        (
            PlanRequest("arm", (), planner="PTP"),
            "INVALID_GOAL_CONSTRAINTS",
            "Exactly one goal constraint required, but 0 goal constraints given",
        ),
        (asked("PTP", MotionConstraints()), "INVALID_GOAL_CONSTRAINTS", "cartesian XOR joint"),
        (
            asked("PTP", joint_goal(9.0, names=("j1",))),
            "INVALID_GOAL_CONSTRAINTS",
            'Joint "j1" violates joint limits in goal constraints',
        ),
        (
            asked("PTP", joint_goal(0.0, names=("j9",))),
            "INVALID_GOAL_CONSTRAINTS",
            'Joint "j9" does not belong to group "arm"',
        ),
        (
            asked("LIN", joint_goal(0.0, names=("j1",))),
            "INVALID_GOAL_CONSTRAINTS",
            "the goal has 1 joints",
        ),
        (
            asked("PTP", pose_goal((5.0, 0.0, 0.0))),
            "NO_IK_SOLUTION",
            "Failed to compute inverse kinematics for link: l6 of goal pose",
        ),
        (
            asked("LIN", pose_goal((0.0, 0.0, 0.0), link="nose")),
            "NO_IK_SOLUTION",
            'No IK solver available for link: "nose"',
        ),
        (PlanRequest("leg", (joint_goal(*START),)), "INVALID_GROUP_NAME", "no group 'leg'"),
        (
            asked("PTP", joint_goal(*START), start={"j2": 9.0}),
            "INVALID_ROBOT_STATE",
            "start state joints outside their position limits: j2",
        ),
    ],
)
def test_requests_that_cannot_be_met(request_, code, sentence):
    assert sentence in refused(MoveItErrorCode[code], request_)


@pytest.mark.parametrize("planner", ["PTP", "LIN"])
@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_numbers_of_a_pose_are_finite(planner, bad):
    sentence = refused(
        MoveItErrorCode.INVALID_GOAL_CONSTRAINTS, asked(planner, pose_goal((bad, 0.0, 0.0)))
    )
    assert "finite" in sentence


def test_a_goal_at_the_end_of_the_world_is_out_of_reach():
    assert refused(MoveItErrorCode.NO_IK_SOLUTION, asked("LIN", pose_goal((1e5, 0.0, 0.0))))


def test_a_rotation_that_is_none_is_refused():
    goal = pose_goal((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))
    assert refused(MoveItErrorCode.INVALID_GOAL_CONSTRAINTS, asked("LIN", goal))


def test_the_point_of_an_arc_is_finite():
    path = auxiliary("interim", (float("nan"), 0.0, 0.0))
    request = asked("CIRC", CIRC["goal"], path=path)
    assert refused(MoveItErrorCode.INVALID_GOAL_CONSTRAINTS, request)


def test_position_and_orientation_are_for_the_same_link():
    goal = pose_goal((0.0, 0.0, 0.0))
    other = dataclasses.replace(goal.orientations[0], link="l5")
    request = asked("PTP", dataclasses.replace(goal, orientations=(other,)))
    assert '"l6" | ' in refused(MoveItErrorCode.INVALID_GOAL_CONSTRAINTS, request)


def test_the_start_of_a_request_goes_before_the_state():
    found = PLANNER.plan(asked("PTP", joint_goal(*START), start={"j1": 0.5}), READY)
    assert found.positions[0] == pytest.approx(START + np.array([0.3, 0, 0, 0, 0, 0]))


def test_a_goal_may_be_given_in_the_frame_of_a_link():
    goal, drop = pose_goal((0.0, 0.0, 0.0)), RigidTransform((0.0, 0.0, -0.02))
    region = dataclasses.replace(goal.positions[0].regions[0], pose=drop)
    position = dataclasses.replace(goal.positions[0], regions=(region,), frame="l6")
    found = PLANNER.plan(asked("LIN", dataclasses.replace(goal, positions=(position,))), READY)
    expected = np.array(TIP.then(drop).position) - TIP.position
    assert tip_offsets(found)[-1] == pytest.approx(expected, abs=1e-5)


def test_joints_are_named_in_the_order_of_the_group():
    assert PLANNER.plan(asked("LIN", pose_goal((0.0, 0.02, 0.0))), READY).joints == NAMES
