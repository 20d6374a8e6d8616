"""The node hello_moveit: a first program for move_group, which brings the gripper to a pose."""

from geometry_msgs.msg import PoseStamped
from rclpy.node import Node

from arm_controller.ros_moveit import MoveGroupInterface, MoveItError
from arm_controller.ros_node import run


class HelloMoveIt(Node):
    """Plans a motion of the arm to a pose, and executes it."""

    def __init__(self) -> None:
        super().__init__("hello_moveit")
        self._arm = MoveGroupInterface(self, "arm", "gripper_base")

    def move(self) -> None:
        """Plan and move.

        Raises:
            MoveItError: there is no plan, or the arm did not get there.
        """
        arm, log = self._arm, self.get_logger()
        arm.connect()
        log.info(f"Planning pipeline: {arm.pipeline_id}")
        log.info(f"Planner ID: {arm.planner_id}")
        log.info(f"Planning time: {arm.planning_time_s:.2f}")
        target = PoseStamped()
        target.header.frame_id = "base_link"
        position, orientation = target.pose.position, target.pose.orientation
        position.x, position.y, position.z = 0.061, -0.176, 0.168
        orientation.x, orientation.w = 1.0, 0.0
        try:
            plan = arm.plan(target)
        except MoveItError:
            log.error("Planning failed!")
            raise
        arm.execute(plan)


def main() -> int:
    """Move once; return 1 if that failed."""
    return run(HelloMoveIt, HelloMoveIt.move)
