"""Topics, services and actions of the packages work between two processes."""

from typing import Any

import pytest
from action_msgs.msg import GoalStatus
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory, ParallelGripperCommand
from control_msgs.msg import JointTolerance
from controller_manager_msgs.srv import ListControllers
from geometry_msgs.msg import TransformStamped
from rclpy.action import ActionClient
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

pytestmark = pytest.mark.ros

TRAJECTORY_ACTION = "/trajectory_controller/follow_joint_trajectory"


def trajectory_goal(count: int) -> FollowJointTrajectory.Goal:
    """Return a goal of that many points, each at its own position."""
    points = [
        JointTrajectoryPoint(
            positions=[0.5 * index, -0.5 * index], time_from_start=Duration(sec=index)
        )
        for index in range(count)
    ]
    return FollowJointTrajectory.Goal(
        trajectory=JointTrajectory(joint_names=["j0", "j1"], points=points),
        path_tolerance=[JointTolerance(name="j0", position=0.1)],
        goal_time_tolerance=Duration(sec=1),
    )


class Goal:
    """A goal that was sent and accepted, and the feedback that came."""

    def __init__(self, client: Any, action_type: type, name: str, goal: Any) -> None:
        self._client = client
        self.feedback: list[Any] = []
        self._action = ActionClient(client.node, action_type, name)
        client.spin_until(self._action.server_is_ready, f"the action {name}")
        client.be_known_to_server(f"{name}/_action/send_goal")
        sent = self._action.send_goal_async(
            goal, feedback_callback=lambda message: self.feedback.append(message.feedback)
        )
        self.handle = client.wait_for(sent, "the answer to the goal")
        assert self.handle.accepted

    def result(self) -> Any:
        """Wait for the result and its status."""
        return self._client.wait_for(self.handle.get_result_async(), "the result")

    def close(self) -> None:
        """Destroy the action client, which the node would not."""
        self._action.destroy()


@pytest.fixture
def send_goal(client):
    """Send goals that are cleaned up before the node is."""
    goals: list[Goal] = []

    def send(action_type: type, name: str, goal: Any) -> Goal:
        goals.append(Goal(client, action_type, name, goal))
        return goals[-1]

    yield send
    for goal in goals:
        goal.close()


def test_transforms_go_there_and_back(client, start_peer):
    received: list[TFMessage] = []
    publisher = client.node.create_publisher(TFMessage, "/there", 10)
    client.node.create_subscription(TFMessage, "/back", received.append, 10)
    start_peer("tf_echo")
    client.spin_until(publisher.get_subscription_count, "a subscription on /there")
    client.spin_until(lambda: client.node.count_publishers("/back"), "a publisher on /back")

    sent = TransformStamped(child_frame_id="hand")
    sent.header.frame_id = "base"
    sent.header.stamp.sec = 12
    sent.transform.translation.x = 0.25
    sent.transform.rotation.w = 0.5

    def arrived() -> bool:
        # Repeated, because the way back may be matched a moment later than the graph says.
        publisher.publish(TFMessage(transforms=[sent, TransformStamped()]))
        return bool(received)

    client.spin_until(arrived, "a message on /back")
    first, second = received[0].transforms
    assert (first.header.frame_id, first.child_frame_id) == ("hand", "base")
    assert first.header.stamp == sent.header.stamp
    assert first.transform == sent.transform
    assert second == TransformStamped()


def test_controllers_are_listed(client, start_peer):
    start_peer("controller_lister")
    service = client.node.create_client(ListControllers, "/controller_manager/list_controllers")
    client.spin_until(service.service_is_ready, "the service")
    client.be_known_to_server(service.service_name)
    answer = client.wait_for(service.call_async(ListControllers.Request()), "the list")
    inner, outer = answer.controller
    assert (inner.name, inner.state, inner.update_rate) == ("inner", "active", 100)
    assert inner.claimed_interfaces == ["j0/position", "j1/position"]
    assert inner.is_chained
    assert not inner.is_async
    assert outer.is_async
    assert outer.chain_connections[0].name == "inner"
    assert outer.chain_connections[0].reference_interfaces == inner.reference_interfaces


def test_trajectory_is_followed(client, start_peer, send_goal):
    start_peer("trajectory_follower")
    goal = send_goal(FollowJointTrajectory, TRAJECTORY_ACTION, trajectory_goal(5))
    answer = goal.result()
    assert answer.status == GoalStatus.STATUS_SUCCEEDED
    assert answer.result.error_code == FollowJointTrajectory.Result.SUCCESSFUL
    assert answer.result.error_string == "arrived"
    client.spin_until(lambda: len(goal.feedback) == 5, "feedback for every point")
    assert [list(one.desired.positions) for one in goal.feedback] == [
        [0.5 * index, -0.5 * index] for index in range(5)
    ]
    assert goal.feedback[0].joint_names == ["j0", "j1"]


def test_trajectory_is_cancelled(client, start_peer, send_goal):
    start_peer("trajectory_follower")
    goal = send_goal(FollowJointTrajectory, TRAJECTORY_ACTION, trajectory_goal(5000))
    client.spin_until(lambda: len(goal.feedback) >= 3, "feedback on the way")
    cancelled = client.wait_for(goal.handle.cancel_goal_async(), "the answer to the cancelling")
    assert len(cancelled.goals_canceling) == 1
    answer = goal.result()
    assert answer.status == GoalStatus.STATUS_CANCELED
    assert answer.result.error_string.startswith("cancelled")


@pytest.mark.parametrize(
    ("wanted_m", "reached_m", "stalled"), [(0.0, 0.01, True), (0.015, 0.015, False)]
)
def test_gripper_closes(client, start_peer, send_goal, wanted_m, reached_m, stalled):
    start_peer("gripper")
    command = JointState(name=["finger"], position=[wanted_m], effort=[5.0])
    goal = send_goal(
        ParallelGripperCommand,
        "/gripper_controller/gripper_cmd",
        ParallelGripperCommand.Goal(command=command),
    )
    answer = goal.result()
    assert answer.status == GoalStatus.STATUS_SUCCEEDED
    assert list(answer.result.state.position) == [reached_m]
    assert list(answer.result.state.effort) == [5.0]
    assert (answer.result.stalled, answer.result.reached_goal) == (stalled, not stalled)
    client.spin_until(lambda: goal.feedback, "feedback")
    assert list(goal.feedback[0].state.position) == [0.02]
