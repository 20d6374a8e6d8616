"""The action ~/gripper_cmd."""

from typing import Any

from rclpy.executors import Executor
from rclpy.node import Node

from arm_control.control_loop import ControlLoop
from arm_control.gripper import GripperController, GripperResult
from arm_control.ros.controller_action import ControllerAction
from arm_control.ros.gripper_messages import GripperDialect


class GripperAction(ControllerAction[GripperController[Any], GripperResult]):
    """The action of a gripper controller; it gives no feedback, as a real one gives none."""

    def __init__(
        self,
        controller: GripperController[Any],
        node: Node,
        loop: ControlLoop,
        executor: Executor,
        dialect: GripperDialect,
        joint: str,
    ) -> None:
        """Offer the action.

        Args:
            controller: takes the goals.
            node: offers the action.
            loop: runs the controller.
            executor: spins the node.
            dialect: the action's type, and its messages.
            joint: the gripper's.
        """
        self._dialect = dialect
        self._joint = joint
        super().__init__(controller, node, loop, executor, dialect.action_type, "~/gripper_cmd")

    def accepts(self, goal: Any) -> bool:
        """Return whether a goal can be followed."""
        return not self.controller.check_goal(self._dialect.request(b"", goal))

    def submit(self, goal_id: bytes, goal: Any) -> GripperResult | None:
        """Start a goal."""
        return self.controller.submit_goal(self._dialect.request(goal_id, goal))

    def result_message(self, result: GripperResult) -> Any:
        """Return how a goal ended."""
        return self._dialect.result(result, self._joint)
