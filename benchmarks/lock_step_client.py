"""A controller in lock-step with the simulation: it answers each joint state with a command.

    python lock_step_client.py TICKS

It prints a JSON line when it is warm, and one at the end: how long the last TICKS control periods
took, and how long its own code ran.
"""

import json
import sys
import time

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, Header

WARM_UP = 500


class Partner(Node):
    """Answers, and counts."""

    def __init__(self) -> None:
        super().__init__("partner")
        self.ticks = 0
        self.callback_s = 0.0
        commands = "/position_controller/commands"
        self._commands = self.create_publisher(Float64MultiArray, commands, 10)
        self._done = self.create_publisher(Header, "~/tick_done", 10)
        self.create_subscription(JointState, "/joint_states", self._answer, 10)
        self._hello = self.create_timer(0.05, lambda: self._done.publish(Header()))

    def _answer(self, state: JointState) -> None:
        began_s = time.perf_counter()
        self._hello.cancel()
        target = [0.99 * position + 0.004 for position in state.position]
        self._commands.publish(Float64MultiArray(data=target))
        self._done.publish(state.header)
        self.ticks += 1
        self.callback_s += time.perf_counter() - began_s


def main() -> None:
    """Run until the ticks are over."""
    wanted = int(sys.argv[1])
    rclpy.init()
    partner = Partner()
    executor = SingleThreadedExecutor()
    executor.add_node(partner)
    while partner.ticks < WARM_UP:
        executor.spin_once()
    print(json.dumps({"warm": True}), flush=True)
    began_s, callback_s, cpu_s = time.perf_counter(), partner.callback_s, time.process_time()
    while partner.ticks < WARM_UP + wanted:
        executor.spin_once()
    seconds = time.perf_counter() - began_s
    print(
        json.dumps(
            {
                "seconds": seconds,
                "callback_s": partner.callback_s - callback_s,
                "cpu_s": time.process_time() - cpu_s,
            }
        ),
        flush=True,
    )
    executor.shutdown()
    partner.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
