"""The action clients of arm and gripper, beside servers that are there already."""

from types import SimpleNamespace

import pytest
import rclpy
from control_msgs.action import FollowJointTrajectory, GripperCommand
from rclpy.action import ActionClient, ActionServer
from rclpy.task import Future

from arm_controller import ros_arm_actions
from arm_controller.ros_arm_actions import ARM_ACTION, GRIPPER_ACTION, ArmActions

pytestmark = pytest.mark.ros


def test_that_the_servers_are_there_is_said_once_however_soon_they_are_found(robot, until, capfd):
    actions = ((FollowJointTrajectory, ARM_ACTION), (GripperCommand, GRIPPER_ACTION))
    servers = robot.node("servers")
    for kind, name in actions:
        ActionServer(servers, kind, name, lambda _: None)
    node = robot.node("loop")
    clients = [ActionClient(node, kind, name) for kind, name in actions]
    until(lambda: all(client.server_is_ready() for client in clients), "both servers")

    arm = ArmActions(node, ["j0"])
    arm.connect()
    arm.connect()
    said = capfd.readouterr().err
    assert said.count("Waiting for action servers...") == 1
    assert said.count("Action servers connected!") == 1


def answered(value: object) -> Future:
    future = Future()
    future.set_result(value)
    return future


class ForgetfulClient:
    """Its server takes the first goal before it knows the client, so that its answer is lost."""

    def __init__(self, *_arguments: object) -> None:
        self.goals: list[object] = []

    def server_is_ready(self) -> bool:
        return True

    def send_goal_async(self, goal: object) -> Future:
        self.goals.append(goal)
        if len(self.goals) == 1:
            return Future()
        ended = answered(SimpleNamespace(result=GripperCommand.Result(reached_goal=True)))
        return answered(SimpleNamespace(accepted=True, get_result_async=lambda: ended))


def test_a_goal_without_an_answer_is_sent_once_more(robot, monkeypatch):
    clients: list[ForgetfulClient] = []

    def client(*arguments: object) -> ForgetfulClient:
        clients.append(ForgetfulClient(*arguments))
        return clients[-1]

    monkeypatch.setattr(ros_arm_actions, "ActionClient", client)
    monkeypatch.setattr(ros_arm_actions, "ANSWER_TIMEOUT_S", 0.1)
    # Nothing arrives, so there is nothing to serve.
    monkeypatch.setattr(rclpy, "spin_until_future_complete", lambda *_, **__: None)
    result = ros_arm_actions.ArmActions(robot.node("loop"), ["j0"]).grip(0.5, 1.0)
    assert isinstance(result, GripperCommand.Result)
    assert result.reached_goal
    _arm, gripper = clients
    assert len(gripper.goals) == 2
    assert gripper.goals[0] == gripper.goals[1]
