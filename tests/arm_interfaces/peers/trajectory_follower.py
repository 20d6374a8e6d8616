"""Follow a trajectory at one point per tick, and stop when it is cancelled."""

import peer
from control_msgs.action import FollowJointTrajectory
from rclpy.action import ActionServer, CancelResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node
from rclpy.task import Future

PERIOD_S = 0.02


class TrajectoryClient:
    """Runs one goal; ticks come from a timer, so that cancelling gets its turn between them."""

    def __init__(self, node: Node, goal: ServerGoalHandle) -> None:
        self._goal = goal
        self._points = list(goal.request.trajectory.points)
        self.ended = Future(executor=node.executor)
        self._timer = node.create_timer(PERIOD_S, self._tick)

    def _tick(self) -> None:
        if self._goal.is_cancel_requested:
            self._goal.canceled()
            self._end(f"cancelled {len(self._points)} points before the end")
            return
        feedback = FollowJointTrajectory.Feedback()
        feedback.joint_names = self._goal.request.trajectory.joint_names
        feedback.desired = self._points.pop(0)
        self._goal.publish_feedback(feedback)
        if not self._points:
            self._goal.succeed()
            self._end("arrived")

    def _end(self, sentence: str) -> None:
        self._timer.destroy()
        self.ended.set_result(FollowJointTrajectory.Result(error_string=sentence))


def create(node: Node) -> ActionServer:
    """Serve the action of a joint trajectory controller."""

    async def execute(goal: ServerGoalHandle) -> FollowJointTrajectory.Result:
        return await TrajectoryClient(node, goal).ended

    return ActionServer(
        node,
        FollowJointTrajectory,
        "/trajectory_controller/follow_joint_trajectory",
        execute,
        cancel_callback=lambda _: CancelResponse.ACCEPT,
    )


if __name__ == "__main__":
    peer.run("trajectory_controller", create)
