"""The demo example_gripper: closes a gripper, opens it halfway, and releases it.

Its node is called gripper_test_node, as in gz_ros2_control_demos.
"""

from rclpy.node import Node
from std_msgs.msg import Float64MultiArray

from arm_controller.ros_arm import MatchedPublisher
from arm_controller.ros_node import declare_match_timeout_s, run, spin_for

COMMANDS = (0.0, 0.38, 0.19, 0.0)
"""In m or N, depending on the gripper's command interface."""
PACE_S = 1.0


class GripperTest(Node):
    """Publishes the commands one after the other, as soon as the controller listens."""

    def __init__(self) -> None:
        super().__init__("gripper_test_node")
        self._match_timeout_s = declare_match_timeout_s(self)
        self._gripper = MatchedPublisher(self, Float64MultiArray, "gripper_controller/commands")

    def close_and_open(self) -> int:
        """Publish all commands; return 1 if there is no subscriber."""
        if not self._gripper.wait_until_ready(self._match_timeout_s):
            return 1
        for command in COMMANDS:
            self._gripper.publish(Float64MultiArray(data=[command]))
            spin_for(self, PACE_S)
        return 0


def main() -> int:
    """Close and open the demo's gripper; return 1 if there is no subscriber."""
    return run(GripperTest, GripperTest.close_and_open)
