"""The action clients of arm and gripper, beside servers that are there already."""

import pytest

pytestmark = pytest.mark.ros


def test_that_the_servers_are_there_is_said_once_however_soon_they_are_found(robot, until, capfd):
    from control_msgs.action import FollowJointTrajectory, GripperCommand
    from rclpy.action import ActionClient, ActionServer

    from arm_controller.ros_arm_actions import ARM_ACTION, GRIPPER_ACTION, ArmActions

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
