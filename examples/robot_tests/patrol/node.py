"""The node: joint states in, commands out."""

import signal

import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from patrol.motion import Patrol


class PatrolNode(Node):
    """Sends a command for each joint state."""

    def __init__(self) -> None:
        super().__init__("patrol")
        self._patrol = Patrol()
        self._was_stuck = False
        self._commands = self.create_publisher(
            Float64MultiArray, "/position_controller/commands", 10
        )
        self.create_subscription(JointState, "/joint_states", self._take, 10)

    def _take(self, state: JointState) -> None:
        stamp, visited = state.header.stamp, self._patrol.visited
        command = self._patrol.command(stamp.sec + 1e-9 * stamp.nanosec, state.position)
        if command is not None:
            self._commands.publish(Float64MultiArray(data=command))
        if self._patrol.visited > visited:
            self.get_logger().info(f"pose {self._patrol.visited} reached")
        if self._patrol.is_stuck and not self._was_stuck:
            self.get_logger().error("the arm is stuck")
        self._was_stuck = self._patrol.is_stuck


def main() -> None:
    """Run the node until Ctrl-C, which ends it at once: it has nothing to put away.

    rclpy's own handlers make a RuntimeError of a Ctrl-C that comes while it reads a message, and a
    node that is destroyed while others send may wait for ever.
    """
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    rclpy.spin(PatrolNode())


if __name__ == "__main__":
    main()
