"""A partner of a lock-stepped simulation: a controller that answers each joint state.

It prints a line for each: the control period, and the positions without any rounding. Its commands
depend on the measured states, so that a run in which one came late would differ.

    python lock_step_partner.py LAST_PERIOD
"""

import sys

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, Header

PERIOD_S = 0.01


class Partner(Node):
    """Moves the joints to and fro, and says so for each control period until the last."""

    def __init__(self, last: int) -> None:
        super().__init__("partner")
        self.is_over = False
        self._last = last
        self._commands = self.create_publisher(Float64MultiArray, "/mover/commands", 10)
        self._done = self.create_publisher(Header, "~/tick_done", 10)
        self.create_subscription(JointState, "/joint_states", self._answer, 10)
        # The first answer says only that it is there.
        self._hello = self.create_timer(0.05, lambda: self._done.publish(Header()))

    def _answer(self, state: JointState) -> None:
        self._hello.cancel()
        period = round((state.header.stamp.sec + state.header.stamp.nanosec * 1e-9) / PERIOD_S)
        print(period, *(position.hex() for position in state.position), flush=True)
        goal = 0.4 if period // 50 % 2 else -0.4
        self._commands.publish(
            Float64MultiArray(data=[0.9 * position + 0.1 * goal for position in state.position])
        )
        if period < self._last:
            self._done.publish(state.header)
        self.is_over = period >= self._last


def main() -> None:
    """Answer until the last period."""
    rclpy.init()
    partner = Partner(int(sys.argv[1]))
    executor = SingleThreadedExecutor()
    executor.add_node(partner)
    while not partner.is_over:
        executor.spin_once()
    executor.shutdown()
    partner.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
