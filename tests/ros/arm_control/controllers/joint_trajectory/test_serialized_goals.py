"""Goals whose waypoints arrive as bytes, not as a hundred thousand Python objects."""

from typing import Any

import pytest
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTolerance
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from unique_identifier_msgs.msg import UUID

import arm_control.controllers.joint_trajectory.ros_serialized_goals

pytestmark = pytest.mark.workaround("serialized_goals")


@pytest.fixture
def goals():
    return arm_control.controllers.joint_trajectory.ros_serialized_goals


def make_request(names: list[str], sizes: list[int]) -> Any:
    points = [
        JointTrajectoryPoint(
            positions=[float(i)] * size,
            effort=[0.5] * size,
            time_from_start=Duration(sec=i, nanosec=7),
        )
        for i, size in enumerate(sizes)
    ]
    goal = FollowJointTrajectory.Goal(
        trajectory=JointTrajectory(joint_names=names, points=points),
        goal_tolerance=[JointTolerance(name=name, position=0.1) for name in names],
        goal_time_tolerance=Duration(sec=4),
    )
    goal.trajectory.header.frame_id = "somewhere"
    goal.trajectory.header.stamp.sec = 12
    return FollowJointTrajectory.Impl.SendGoalService.Request(
        goal_id=UUID(uuid=list(range(16))), goal=goal
    )


@pytest.mark.parametrize(
    ("names", "sizes"),
    [([], []), (["j0"], [1]), (["j0", "second"], [2] * 5), (["a", "b", "c"], [3, 0, 2, 3])],
)
def test_waypoints_stay_bytes_and_the_rest_is_a_message(goals, names, sizes):
    request = make_request(names, sizes)
    conversion = goals.GoalConversion()
    assert conversion.reads(request)
    taken = conversion.round_trip(request)
    assert taken.goal_id == request.goal_id
    assert list(taken.goal.request.joint_names) == names
    assert not taken.goal.message.trajectory.points
    assert taken.goal.message.goal_tolerance == request.goal.goal_tolerance
    read = taken.goal.request.points
    assert [list(point.positions) for point in read] == [[i] * n for i, n in enumerate(sizes)]
    assert [list(point.effort) for point in read] == [[0.5] * n for n in sizes]


def test_the_installed_rclpy_supports_it(goals):
    """Otherwise a large goal would stop the control loop as long as rclpy converts it."""
    action_type = goals.serializing_action_type()
    assert action_type is not FollowJointTrajectory
    assert action_type.Feedback is FollowJointTrajectory.Feedback


@pytest.mark.parametrize("fault", [OSError, AttributeError, ValueError])
def test_where_it_cannot_goals_are_taken_as_messages(goals, monkeypatch, fault):
    def refuse(_self: Any) -> None:
        raise fault("not there")

    monkeypatch.setattr(goals.GoalConversion, "__init__", refuse)
    assert goals.serializing_action_type() is FollowJointTrajectory
    message = make_request(["j0"], [1, 1]).goal
    assert [list(p.positions) for p in goals.taken_goal(message).request.points] == [[0.0], [1.0]]
