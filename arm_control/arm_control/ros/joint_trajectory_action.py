"""The action ~/follow_joint_trajectory."""

from collections.abc import Callable

from control_msgs.action import FollowJointTrajectory
from rclpy.executors import Executor
from rclpy.node import Node

from arm_control.control_loop import ControlLoop
from arm_control.joint_trajectory import (
    Feedback,
    GoalResult,
    JointTrajectoryController,
    StateLayout,
)
from arm_control.ros.controller_action import ControllerAction
from arm_control.ros.joint_trajectory_messages import (
    feedback_message,
    goal_request,
    result_message,
    trajectory_request,
)


class JointTrajectoryAction(ControllerAction[JointTrajectoryController, GoalResult]):
    """The action of the joint trajectory controller, with its feedback."""

    def __init__(
        self,
        controller: JointTrajectoryController,
        node: Node,
        loop: ControlLoop,
        executor: Executor,
        accepts_faulty: Callable[[], bool],
    ) -> None:
        """Offer the action.

        Args:
            controller: takes the goals.
            node: offers the action.
            loop: runs the controller.
            executor: spins the node.
            accepts_faulty: whether a goal with a fault is accepted, and aborted with the reason.
        """
        self._accepts_faulty = accepts_faulty
        super().__init__(
            controller, node, loop, executor, FollowJointTrajectory, "~/follow_joint_trajectory"
        )

    def publish_feedback(self, goal_id: bytes, layout: StateLayout, feedback: Feedback) -> None:
        """Tell how a goal is getting on; loop thread."""
        self.handle_of(goal_id).publish_feedback(feedback_message(layout, feedback))

    def accepts(self, goal: FollowJointTrajectory.Goal) -> bool:
        """Return whether a goal can be followed, or is to be aborted with the reason."""
        refusal = self.controller.check_goal(trajectory_request(goal.trajectory))
        return refusal is None or self._accepts_faulty()

    def submit(self, goal_id: bytes, goal: FollowJointTrajectory.Goal) -> GoalResult | None:
        """Start a goal."""
        return self.controller.submit_goal(goal_request(goal_id, goal))

    def result_message(self, result: GoalResult) -> FollowJointTrajectory.Result:
        """Return how a goal ended."""
        return result_message(result)
