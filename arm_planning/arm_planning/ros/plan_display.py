"""The topic display_planned_path: each plan, as RViz shows it."""

from collections.abc import Sequence

from moveit_msgs.msg import DisplayTrajectory
from rclpy.node import Node

from arm_planning.robot.model import JointPositions, PlanningModel
from arm_planning.ros.convert import robot_state_message, trajectory_message
from arm_planning.trajectory import TimedTrajectory

DEPTH = 10


class PlanDisplay:
    """Publishes plans while somebody subscribes; any thread may call it."""

    def __init__(self, node: Node, model: PlanningModel) -> None:
        self._model = model
        self._publisher = node.create_publisher(DisplayTrajectory, "display_planned_path", DEPTH)

    def show(self, start: JointPositions, trajectories: Sequence[TimedTrajectory | None]) -> None:
        """Publish motions that follow one another; None for a plan that failed shows nothing."""
        found = [each for each in trajectories if each is not None]
        if not found or not self._publisher.get_subscription_count():
            return
        message = DisplayTrajectory(model_id=self._model.robot.name)
        message.trajectory = [trajectory_message(self._model.frame, each) for each in found]
        message.trajectory_start = robot_state_message(self._model, start)
        self._publisher.publish(message)
