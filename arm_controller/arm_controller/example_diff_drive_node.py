"""The demo example_diff_drive: drives a robot with two wheels in circles until Ctrl-C.

Its node is called diff_drive_test_node, as in gz_ros2_control_demos.
"""

from geometry_msgs.msg import TwistStamped
from rclpy.node import Node

from arm_controller.ros_arm import MatchedPublisher
from arm_controller.ros_node import declare_match_timeout_s, run, spin_for

FORWARDS_M_S, TO_THE_LEFT_RAD_S = 0.1, 0.1
PACE_S = 0.05


class DiffDriveTest(Node):
    """Publishes the same velocity again and again, as soon as the controller listens."""

    def __init__(self) -> None:
        super().__init__("diff_drive_test_node")
        self._match_timeout_s = declare_match_timeout_s(self)
        topic = "diff_drive_base_controller/cmd_vel"
        self._wheels = MatchedPublisher(self, TwistStamped, topic)

    def drive(self) -> int:
        """Drive for ever; return 1 if there is no subscriber."""
        if not self._wheels.wait_until_ready(self._match_timeout_s):
            return 1
        # Without a stamp the command counts as new, even if the controller uses simulation time.
        command = TwistStamped()
        command.twist.linear.x = FORWARDS_M_S
        command.twist.angular.z = TO_THE_LEFT_RAD_S
        while True:
            self._wheels.publish(command)
            spin_for(self, PACE_S)


def main() -> int:
    """Drive the demo's robot in circles until Ctrl-C; return 1 if there is no subscriber."""
    return run(DiffDriveTest, DiffDriveTest.drive)
