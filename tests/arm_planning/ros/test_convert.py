"""Poses, states and trajectories from and to messages."""

import math

import numpy as np
import pytest
from builtin_interfaces.msg import Duration
from geometry_msgs.msg import Pose
from moveit_msgs.msg import RobotState, RobotTrajectory
from planar_robot import planar_model
from trajectory_msgs.msg import JointTrajectoryPoint, MultiDOFJointTrajectoryPoint

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.ros.convert import (
    duration_message,
    error_code,
    joint_positions,
    pose_message,
    pose_of,
    robot_state_message,
    seconds,
    trajectory_message,
    trajectory_of,
)
from arm_planning.trajectory import TimedTrajectory


def state(**positions: float) -> RobotState:
    message = RobotState()
    message.joint_state.name = list(positions)
    message.joint_state.position = list(positions.values())
    return message


def test_a_pose_comes_back_as_it_was():
    half = math.sqrt(0.5)
    pose = RigidTransform((1.0, -2.0, 3.5), (0.0, half, 0.0, half))
    assert pose_of(pose_message(pose), "it") == pose


def test_a_pose_that_is_none_is_refused_in_a_sentence():
    message = Pose()
    message.orientation.w = 0.0
    with pytest.raises(PlanningError, match="the orientation of the goal is no unit quaternion"):
        pose_of(message, "the goal")
    message = Pose()
    message.position.y = math.nan
    with pytest.raises(PlanningError, match="the position of the goal is not finite: 0, nan, 0"):
        pose_of(message, "the goal")


def test_a_duration_comes_back_within_a_nanosecond():
    for time_s in (0.0, 1e-9, 0.1, 3.999999999, 1e6 + 0.25):
        assert seconds(duration_message(time_s)) == pytest.approx(time_s, abs=1e-9)
    assert seconds(Duration(sec=1, nanosec=500_000_000)) == 1.5


def test_a_success_has_no_source_and_a_failure_says_who():
    assert error_code(MoveItErrorCode.SUCCESS).source == ""
    failed = error_code(MoveItErrorCode.NO_IK_SOLUTION, "out of reach")
    assert (failed.val, failed.message, failed.source) == (-31, "out of reach", "move_group")


def test_joints_that_are_not_the_robots_warn_and_mimic_joints_are_passed_over():
    warnings: list[str] = []
    message = state(shoulder=0.5, grip=0.01, elbwo=1.0)
    assert joint_positions(planar_model(), message, warnings.append) == {"shoulder": 0.5}
    assert warnings == [
        "a state names the joint 'elbwo', which the robot does not have; did you mean 'elbow'?"
    ]


def test_a_state_with_fewer_positions_than_names_is_ignored_as_upstream():
    message = state(shoulder=0.5)
    message.joint_state.name = ["shoulder", "elbow"]
    warnings: list[str] = []
    assert joint_positions(planar_model(), message, warnings.append) == {}
    assert warnings[0].endswith("in JointState message: 2, 1")


def test_a_position_that_is_not_finite_is_an_invalid_state():
    with pytest.raises(PlanningError, match="the position of joint 'elbow' is nan") as error:
        joint_positions(planar_model(), state(elbow=math.nan), print)
    assert error.value.code is MoveItErrorCode.INVALID_ROBOT_STATE


def test_a_state_message_has_all_joints_mimic_joints_included():
    message = robot_state_message(planar_model(), {"shoulder": 0.5, "elbow": 1.0})
    positions = dict(zip(message.joint_state.name, message.joint_state.position, strict=True))
    assert positions == {"shoulder": 0.5, "elbow": 1.0, "grip": 0.01}
    assert message.joint_state.header.frame_id == "base"


def test_a_trajectory_comes_back_as_it_was():
    times = np.array([0.0, 0.1, 0.25])
    values = np.arange(6.0).reshape(3, 2)
    given = TimedTrajectory(("shoulder", "elbow"), times, values, 2.0 * values, -values)
    message = trajectory_message("base", given)
    assert message.joint_trajectory.header.frame_id == "base"
    back = trajectory_of(message)
    assert back.joints == given.joints
    np.testing.assert_allclose(back.times_s, times, atol=1e-9)
    np.testing.assert_array_equal(back.positions, values)
    np.testing.assert_array_equal(back.velocities, 2.0 * values)
    np.testing.assert_array_equal(back.accelerations, -values)


def points(*rows: tuple[float, list[float]]) -> RobotTrajectory:
    message = RobotTrajectory()
    message.joint_trajectory.joint_names = ["shoulder", "elbow"]
    message.joint_trajectory.points = [
        JointTrajectoryPoint(positions=positions, time_from_start=duration_message(time_s))
        for time_s, positions in rows
    ]
    return message


def with_velocities(value: float) -> RobotTrajectory:
    message = points((0.0, [0.0, 0.0]))
    message.joint_trajectory.points[0].velocities = [value, value]
    return message


def naming(*joints: str) -> RobotTrajectory:
    message = points((0.0, [0.0, 0.0]))
    message.joint_trajectory.joint_names = list(joints)
    return message


def with_a_base() -> RobotTrajectory:
    message = RobotTrajectory()
    message.multi_dof_joint_trajectory.points = [MultiDOFJointTrajectoryPoint()]
    return message


def test_velocities_that_are_not_given_are_nan():
    trajectory = trajectory_of(points((0.0, [0.0, 0.0]), (1.0, [1.0, 1.0])))
    assert np.isnan(trajectory.velocities).all()


@pytest.mark.parametrize(
    ("message", "problem"),
    [
        (points((0.0, [0.0])), "point 0 of the trajectory has 1 positions for 2 joints"),
        (points((0.0, [0.0, math.inf])), "point 0 .* positions that are not finite: 0.0, inf"),
        (with_velocities(math.nan), "point 0 .* velocities that are not finite: nan, nan"),
        (naming("elbow", "elbow"), "names elbow more than once"),
        (with_a_base(), "multi_dof_joint_trajectory"),
        (points((0.5, [0.0, 0.0]), (0.5, [1.0, 1.0])), "point 1 .* is not later"),
    ],
)
def test_a_trajectory_that_cannot_be_driven_is_refused(message, problem):
    with pytest.raises(PlanningError, match=problem) as error:
        trajectory_of(message)
    assert error.value.code is MoveItErrorCode.INVALID_MOTION_PLAN


def test_no_trajectory_is_an_empty_message():
    assert trajectory_message("base", None) == RobotTrajectory()
    assert trajectory_of(RobotTrajectory()).duration_s == 0.0
