"""A client that does not use the suite: default QoS, default environment. One job in each run.

Prints one JSON line per answer; wall times are CLOCK_MONOTONIC, the same in every process.
"""

import argparse
import contextlib
import json
import random
import threading
import time
from collections import deque
from collections.abc import Callable

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Float64MultiArray

TYPES = {"/joint_states": JointState, "/videocamera": Image, "/clock": Clock}


def say(**answer: object) -> None:
    """Print one answer."""
    print(json.dumps(answer), flush=True)


def spin_until(node: Node, condition: Callable[[], bool], timeout_s: float = 60.0) -> None:
    """Spin until the condition holds."""
    deadline = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline:
            raise SystemExit("timeout")
        rclpy.spin_once(node, timeout_sec=0.05)


def first_message(node: Node, topic: str) -> None:
    """Say when the node was there, and when the first message came."""
    arrivals: list[float] = []
    node.create_subscription(TYPES[topic], topic, lambda _: arrivals.append(time.monotonic()), 10)
    say(node_made_s=time.monotonic())
    spin_until(node, lambda: bool(arrivals))
    say(first_s=arrivals[0])


def record(node: Node, topic: str, seconds: float, best_effort: bool) -> None:
    """Say when each message of some seconds came, and its stamp."""
    arrivals: list[float] = []
    stamps: list[float] = []

    def note(message: JointState | Image | Clock) -> None:
        arrivals.append(time.monotonic())
        stamp = message.clock if isinstance(message, Clock) else message.header.stamp
        stamps.append(stamp.sec + stamp.nanosec * 1e-9)

    reliability = ReliabilityPolicy.BEST_EFFORT if best_effort else ReliabilityPolicy.RELIABLE
    node.create_subscription(
        TYPES[topic], topic, note, QoSProfile(depth=10, reliability=reliability)
    )
    spin_until(node, lambda: bool(arrivals))
    end = arrivals[0] + seconds
    spin_until(node, lambda: time.monotonic() > end)
    say(arrivals_s=arrivals, stamps_s=stamps)


def command_latency(node: Node, steps: int, namespace: str) -> None:
    """Say how long after a command the first joint state shows motion, step by step.

    The executor spins in a thread, so that commands fall anywhere in the control period and not
    always right after a joint state.
    """
    states: deque[tuple[float, float]] = deque(maxlen=5000)
    prefix = f"{namespace.removeprefix('/')}_" if namespace else ""
    node.create_subscription(
        JointState,
        f"{namespace}/joint_states",
        lambda m: states.append((time.monotonic(), m.position[m.name.index(f"{prefix}j0")])),
        10,
    )
    commands = f"{namespace}/position_controller/commands"
    publisher = node.create_publisher(Float64MultiArray, commands, 10)
    done = threading.Event()
    spinning = threading.Thread(target=spin_until, args=(node, done.is_set, 3600.0))
    spinning.start()
    wait_until(lambda: bool(states) and publisher.get_subscription_count() > 0)
    time.sleep(0.3)
    phases = random.Random(1)
    goal = 0.0
    latencies = []
    for _ in range(steps):
        wait_until(lambda g=goal: still(list(states), g))
        time.sleep(phases.uniform(0.0, 0.02))
        origin, goal = states[-1][1], 0.3 - goal
        sent = time.monotonic()
        publisher.publish(Float64MultiArray(data=[goal, 0.0, 0.0, 0.0]))
        wait_until(lambda o=origin: abs(states[-1][1] - o) > 1e-3, 0.02)
        latencies.append(next(t for t, q in list(states) if t > sent and abs(q - origin) > 1e-3))
        latencies[-1] -= sent
    done.set()
    spinning.join()
    say(latencies_s=latencies)


def wait_until(condition: Callable[[], bool], poll_s: float = 0.05) -> None:
    """Sleep until the condition holds."""
    deadline = time.monotonic() + 60.0
    while not condition():
        if time.monotonic() > deadline:
            raise SystemExit("timeout")
        time.sleep(poll_s)


def still(states: list[tuple[float, float]], goal: float) -> bool:
    """Return whether j0 has been at rest at the goal for 0.3 s."""
    now = time.monotonic()
    recent = [q for t, q in states if t > now - 0.3]
    return len(recent) > 5 and abs(recent[-1] - goal) < 0.01 and max(recent) - min(recent) < 1e-4


def main() -> None:
    """Do the one job that the arguments name."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("job", choices=["first", "record", "latency"])
    parser.add_argument("--topic", default="/joint_states", choices=sorted(TYPES))
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--steps", type=int, default=50)
    parser.add_argument("--namespace", default="", help="of the arm that is commanded, /arm_0")
    parser.add_argument("--best-effort", action="store_true")
    arguments = parser.parse_args()
    rclpy.init()
    node = Node("default_client")
    if arguments.job == "first":
        first_message(node, arguments.topic)
    elif arguments.job == "record":
        record(node, arguments.topic, arguments.seconds, arguments.best_effort)
    else:
        command_latency(node, arguments.steps, arguments.namespace)
    # The signal that ends the client may have done so, in the midst of this.
    with contextlib.suppress(RuntimeError):
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
