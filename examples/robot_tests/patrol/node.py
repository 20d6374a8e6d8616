"""The node: joint states in, commands out."""

import signal
from types import FrameType

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
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
    """Run the node until it is interrupted."""
    interrupts: list[int] = []

    def interrupt(number: int, _: FrameType | None) -> None:
        interrupts.append(number)
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, interrupt)
    rclpy.init()
    node = PatrolNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except Exception:
        # Ctrl-C in the middle of a message: rclpy makes a RuntimeError of it while it reads one,
        # and cannot send another.
        if rclpy.ok() and not interrupts:
            raise
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
