"""A client of servo_node: command to motion beside a position controller, and the rate of commands.

    python benchmarks/jog_client.py latency|rate COUNT_OR_SECONDS

Prints one JSON line when it begins and one with what it found.
"""

import contextlib
import json
import random
import sys
import time

import rclpy
from control_msgs.msg import JointJog
from moveit_msgs.srv import ServoCommandType
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.utilities import try_shutdown
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

JOINT = "link1_to_link2"
COMMANDS = "/position_controller/commands"
MOVED = 2e-5
"""More than a joint at rest trembles, in rad."""
STEP = 0.02
STILL = 30
"""Joint states in a row at one place."""
TIMEOUT_S = 60.0
QOS = QoSProfile(depth=100, reliability=ReliabilityPolicy.BEST_EFFORT)


def say(**answer: object) -> None:
    print(json.dumps(answer), flush=True)


class JogClient:
    """Commands the joint, directly or by a jog, and watches it."""

    def __init__(self) -> None:
        self.node = Node("jog_client")
        self.states: list[JointState] = []
        self.commands = 0
        self.node.create_subscription(JointState, "/joint_states", self.states.append, QOS)
        self.node.create_subscription(Float64MultiArray, COMMANDS, self._count, QOS)
        self.direct = self.node.create_publisher(Float64MultiArray, COMMANDS, 10)
        self.jogs = self.node.create_publisher(JointJog, "/servo_node/delta_joint_cmds", 10)
        switch = self.node.create_client(ServoCommandType, "/servo_node/switch_command_type")
        switch.wait_for_service(TIMEOUT_S)
        request = ServoCommandType.Request(command_type=ServoCommandType.Request.JOINT_JOG)
        future = switch.call_async(request)
        rclpy.spin_until_future_complete(self.node, future, timeout_sec=TIMEOUT_S)
        self.wait(lambda: self.states, "joint states")

    def _count(self, _: Float64MultiArray) -> None:
        self.commands += 1

    def wait(self, condition, what: str) -> None:
        deadline = time.monotonic() + TIMEOUT_S
        while not condition():
            rclpy.spin_once(self.node, timeout_sec=0.05)
            if time.monotonic() > deadline:
                raise SystemExit(f"not within {TIMEOUT_S:g} s: {what}")

    def position(self, state: JointState | None = None) -> float:
        state = state or self.states[-1]
        return state.position[state.name.index(JOINT)]

    def come_to_rest(self) -> None:
        self.states.clear()

        def rests() -> bool:
            last = [self.position(state) for state in self.states[-STILL:]]
            return len(last) == STILL and max(last) - min(last) < MOVED / 10

        self.wait(rests, "the robot at rest")
        # Anywhere in the period.
        time.sleep(random.uniform(0.0, 0.02))
        rclpy.spin_once(self.node, timeout_sec=0.0)

    def arm_positions(self) -> list[float]:
        named = dict(zip(self.states[-1].name, self.states[-1].position, strict=True))
        return [named[name] for name in named if name.startswith("link")]

    def jog(self, speed: float) -> None:
        message = JointJog(joint_names=[JOINT], velocities=[speed])
        message.header.stamp = self.states[-1].header.stamp
        self.jogs.publish(message)

    def latency_s(self, by_jog: bool, sign: float) -> float:
        """Return the time from a command to the first state that shows motion."""
        self.come_to_rest()
        before, target = self.position(), self.arm_positions()
        target[0] += sign * STEP
        began = time.monotonic()
        if by_jog:
            self.jog(sign)
        else:
            self.direct.publish(Float64MultiArray(data=target))
        self.wait(lambda: abs(self.position() - before) > MOVED, f"motion, {by_jog=}")
        return time.monotonic() - began

    def rate(self, seconds: float) -> float:
        """Return the commands of a jog over those that are wanted, at 100 a simulated second."""
        sign, ends = 1.0, time.monotonic() + seconds
        start = None
        while time.monotonic() < ends:
            seen = len(self.states)
            rclpy.spin_once(self.node, timeout_sec=0.05)
            if len(self.states) == seen:
                continue
            if abs(self.position()) > 1.5 and self.position() * sign > 0.0:
                sign = -sign
            self.jog(sign)
            if start is None and self.commands > 20:
                start = (self.commands, stamp_s(self.states[-1]))
        assert start is not None
        return (self.commands - start[0]) / (stamp_s(self.states[-1]) - start[1]) / 100.0


def stamp_s(state: JointState) -> float:
    return state.header.stamp.sec + state.header.stamp.nanosec * 1e-9


def main() -> None:
    job, amount = sys.argv[1], float(sys.argv[2])
    rclpy.init()
    client = JogClient()
    say(begins=True)
    if job == "latency":
        found: dict[bool, list[float]] = {False: [], True: []}
        for number in range(int(amount)):
            for by_jog, values in found.items():
                values.append(client.latency_s(by_jog, 1.0 if number % 2 else -1.0))
        say(direct_s=found[False], jog_s=found[True])
    else:
        say(rate=client.rate(amount))
    with contextlib.suppress(RuntimeError):
        try_shutdown()


if __name__ == "__main__":
    main()
