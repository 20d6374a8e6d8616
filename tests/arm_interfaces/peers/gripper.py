"""Close a gripper until it stalls at 0.01 m."""

import peer
from control_msgs.action import ParallelGripperCommand
from rclpy.action import ActionServer
from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node
from sensor_msgs.msg import JointState

OBJECT_WIDTH_M = 0.01


def execute(goal: ServerGoalHandle) -> ParallelGripperCommand.Result:
    """Report one state on the way, and the object between the fingers as the end."""
    command = goal.request.command
    moving = JointState(name=command.name, position=[0.02])
    goal.publish_feedback(ParallelGripperCommand.Feedback(state=moving))
    wanted_m = command.position[0]
    stalled = wanted_m < OBJECT_WIDTH_M
    goal.succeed()
    return ParallelGripperCommand.Result(
        state=JointState(
            name=command.name, position=[max(wanted_m, OBJECT_WIDTH_M)], effort=command.effort
        ),
        stalled=stalled,
        reached_goal=not stalled,
    )


def create(node: Node) -> ActionServer:
    """Serve the action of a gripper controller."""
    return ActionServer(node, ParallelGripperCommand, "/gripper_controller/gripper_cmd", execute)


if __name__ == "__main__":
    peer.run("gripper_controller", create)
