"""A client beside several arms: it counts the joint states of each, or commands all of them.

Counting prints one JSON line. Commanding prints one as soon as it begins, and goes on until a
signal.
"""

import contextlib
import json
import sys
import time
from collections import Counter
from functools import partial

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

DEPTH = 100
"""Of the queues, so that the client's own pauses lose nothing."""
TIMEOUT_S = 60.0
COMMANDS_HZ = 100


def count(node: Node, names: list[str], seconds: float) -> dict[str, float]:
    """Return the rate of each arm's joint states in Hz over some seconds."""
    counts: Counter[str] = Counter()

    def note(name: str, _message: bytes) -> None:
        counts[name] += 1

    for name in names:
        node.create_subscription(
            JointState,
            f"{name}/joint_states",
            partial(note, name),
            QoSProfile(depth=DEPTH),
            raw=True,
        )
    deadline = time.monotonic() + TIMEOUT_S
    while len(counts) < len(names):
        rclpy.spin_once(node, timeout_sec=0.05)
        if time.monotonic() > deadline:
            raise SystemExit(f"no joint states of {sorted(set(names) - counts.keys())}")
    before, started = Counter(counts), time.monotonic()
    while time.monotonic() < started + seconds:
        rclpy.spin_once(node, timeout_sec=0.05)
    elapsed = time.monotonic() - started
    return {name: (counts[name] - before[name]) / elapsed for name in names}


def command(node: Node, names: list[str]) -> None:
    """Command all arms to stay where they are, `COMMANDS_HZ` times a second."""
    publishers = [
        node.create_publisher(Float64MultiArray, f"{name}/position_controller/commands", 10)
        for name in names
    ]
    while not all(publisher.get_subscription_count() for publisher in publishers):
        time.sleep(0.05)
    print("{}", flush=True)
    due = time.monotonic()
    while True:
        for publisher in publishers:
            publisher.publish(Float64MultiArray(data=[0.0] * 4))
        due += 1 / COMMANDS_HZ
        time.sleep(max(0.0, due - time.monotonic()))


def main() -> None:
    """Do the job that the arguments name."""
    job, seconds, *names = sys.argv[1:]
    rclpy.init()
    node = Node("many_arms_client")
    if job == "count":
        print(json.dumps(count(node, names, float(seconds))), flush=True)
    else:
        with contextlib.suppress(Exception):  # A signal ends it in the midst of this.
            command(node, names)
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
