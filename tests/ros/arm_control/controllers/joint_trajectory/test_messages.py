"""Conversions between messages and the joint trajectory controller's own types."""

import numpy as np
import pytest
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTolerance as Message
from control_msgs.srv import QueryTrajectoryState
from rclpy.serialization import serialize_message
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_control.controllers.joint_trajectory.goals import ErrorCode, GoalResult, JointTolerance
from arm_control.controllers.joint_trajectory.ros_serialized_goals import taken_goal
from arm_control.controllers.joint_trajectory.serialized import read_trajectory
from arm_control.controllers.joint_trajectory.state import (
    Feedback,
    Progress,
    QueriedState,
    StateLayout,
)

LAYOUT = StateLayout(
    joints=("j0", "j1"),
    reference=("position", "velocity", "acceleration"),
    feedback=("position", "velocity"),
    error=("position", "velocity"),
    output=("position",),
)


@pytest.fixture
def messages():
    import arm_control.controllers.joint_trajectory.ros

    return arm_control.controllers.joint_trajectory.ros


@pytest.fixture
def times():
    import arm_control.controllers.ros_adapter

    return arm_control.controllers.ros_adapter


def test_seconds_of_negative_durations(times):
    assert times.seconds_of(Duration(sec=-1, nanosec=0)) == -1.0
    assert times.seconds_of(Duration(sec=-1, nanosec=500_000_000)) == -0.5


def test_a_trajectory():
    message = JointTrajectory(joint_names=["j1", "j0"])
    message.header.stamp.sec, message.header.stamp.nanosec = 3, 250_000_000
    message.points = [
        JointTrajectoryPoint(
            positions=[1.0, 2.0],
            velocities=[3.0, 4.0],
            effort=[5.0, 6.0],
            time_from_start=Duration(sec=1, nanosec=500_000_000),
        )
    ]
    request = read_trajectory(serialize_message(message))
    assert request.joint_names == ["j1", "j0"]
    assert request.stamp_s == 3.25
    (point,) = request.points
    assert point.time_from_start_s == 1.5
    assert [list(point.positions), list(point.velocities)] == [[1.0, 2.0], [3.0, 4.0]]
    assert [list(point.accelerations), list(point.effort)] == [[], [5.0, 6.0]]


def test_a_goal_with_tolerances(messages):
    goal = FollowJointTrajectory.Goal(
        path_tolerance=[Message(name="j0", position=0.1, velocity=0.2, acceleration=0.3)],
        goal_tolerance=[Message(name="j1", position=-1.0)],
        goal_time_tolerance=Duration(sec=2),
    )
    request = messages.goal_request("me", taken_goal(goal))
    assert request.id == "me"
    assert request.path_tolerance == (JointTolerance("j0", 0.1, 0.2, 0.3),)
    assert request.goal_tolerance == (JointTolerance("j1", -1.0, 0.0, 0.0),)
    assert request.goal_time_tolerance_s == 2.0


def test_a_result(messages):
    result = messages.result_message(GoalResult.aborted(ErrorCode.PATH_TOLERANCE_VIOLATED, "off"))
    assert (result.error_code, result.error_string) == (-4, "off")


def test_feedback(messages, times):
    feedback = Feedback(
        2.5,
        Progress(0.75, 1.0),
        np.arange(6.0).reshape(3, 2),
        np.ones((2, 2)),
        np.full((2, 2), np.nan),
    )
    message = messages.feedback_message(LAYOUT, feedback)
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (2, 500_000_000)
    assert list(message.joint_names) == ["j0", "j1"]
    assert list(message.desired.positions) == [0.0, 1.0]
    assert list(message.desired.accelerations) == [4.0, 5.0]
    assert list(message.actual.velocities) == [1.0, 1.0]
    assert not message.actual.accelerations
    assert np.isnan(message.error.velocities).all()
    parts = (message.desired, message.actual, message.error)
    assert [list(part.effort) for part in parts] == [[0.0, 0.0]] * 3
    assert [times.seconds_of(part.time_from_start) for part in parts] == [0.75, 1.0, -0.25]


@pytest.mark.parametrize(
    ("time_s", "parts"),
    [
        (1.5, (1, 500_000_000)),
        (-0.25, (-1, 750_000_000)),
        (1e12, (2**31 - 1, 0)),
        (-1e12, (-(2**31), 0)),
    ],
)
def test_a_duration_is_as_long_as_it_can_be(times, time_s, parts):
    message = times.duration_message(time_s)
    assert (message.sec, message.nanosec) == parts


def test_an_answer_of_a_controller_without_motion_has_no_names(messages):
    response = QueryTrajectoryState.Response()
    messages.fill_query_response(response, ("j0",), QueriedState("asleep", np.empty((3, 0))))
    assert (response.success, response.message, list(response.name)) == (False, "asleep", [])


def test_an_answer_with_motion(messages):
    response = QueryTrajectoryState.Response()
    messages.fill_query_response(response, ("j0",), QueriedState("", np.array([[1.0], [2], [3]])))
    assert response.success
    assert list(response.name) == ["j0"]
    assert [response.position[0], response.velocity[0], response.acceleration[0]] == [1, 2, 3]
