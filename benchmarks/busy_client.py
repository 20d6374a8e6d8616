"""Clients that keep the simulation's process busy, and one that watches its pace. One job a run.

Prints JSON lines; wall times are CLOCK_MONOTONIC, simulated ones those of /clock.
"""

import argparse
import contextlib
import faulthandler
import json
import os
import time
from typing import Any

import rclpy
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.action.client import ActionClient
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from rclpy.utilities import try_shutdown
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

JOINTS = ["j0", "j1", "j2", "j3"]
GRACE_S = 60.0
BEST_EFFORT = QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT)


def say(**answer: object) -> None:
    """Print one answer."""
    print(json.dumps(answer), flush=True)


def watch(node: Node, seconds: float) -> None:
    """Say when each /clock came and what it said, and what the manager says of its lag."""
    with contextlib.suppress(PermissionError):
        os.nice(-15)
    ticks: list[tuple[float, bytes]] = []
    lags: list[tuple[float, float, int]] = []

    def note(message: DiagnosticArray) -> None:
        for status in message.status:
            values = {item.key: item.value for item in status.values}
            if "max_lag" in values:
                lag_ms = float(values["max_lag"].split()[0])
                lags.append((time.monotonic(), lag_ms, int(values["overruns"])))

    node.create_subscription(
        Clock, "/clock", lambda m: ticks.append((time.monotonic(), m)), BEST_EFFORT, raw=True
    )
    node.create_subscription(DiagnosticArray, "/diagnostics", note, 10)
    while not ticks:
        rclpy.spin_once(node, timeout_sec=0.05)
    say(watching=True)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)
    clocks = [(arrived_s, deserialize_message(m, Clock).clock) for arrived_s, m in ticks]
    say(ticks=[(arrived_s, c.sec + c.nanosec * 1e-9) for arrived_s, c in clocks], lags=lags)


def look_at_pictures(node: Node, seconds: float) -> None:
    """Say how many pictures came."""
    pictures: list[int] = []
    node.create_subscription(Image, "/videocamera", lambda m: pictures.append(len(m.data)), 10)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)
    say(pictures=len(pictures))


def send_goal(node: Node, action_name: str, points: int, wait_s: float) -> None:
    """Make one goal with so many points, send it after a line from the standard input."""
    goal = FollowJointTrajectory.Goal(
        trajectory=JointTrajectory(
            joint_names=JOINTS, points=[point(index, points) for index in range(points)]
        )
    )
    client = ActionClient(node, FollowJointTrajectory, action_name)
    deadline = time.monotonic() + wait_s
    while not client.server_is_ready() and time.monotonic() < deadline:
        rclpy.spin_once(node, timeout_sec=0.05)
    time.sleep(1.0)
    say(made=True)
    input()
    sent_s = time.monotonic()
    future = client.send_goal_async(goal)
    called_s = time.monotonic()
    while not future.done() and time.monotonic() < sent_s + wait_s:
        rclpy.spin_once(node, timeout_sec=0.05)
    handle: Any = future.result() if future.done() else None
    say(
        accepted=bool(handle and handle.accepted),
        sent_s=sent_s,
        send_took_s=called_s - sent_s,
        answered_s=time.monotonic(),
    )


def point(index: int, count: int) -> JointTrajectoryPoint:
    """Return a way point: all joints creep in step, and stand at the last one."""
    seconds, hundredths = divmod(index + 1, 100)
    where = 1e-6 * index
    return JointTrajectoryPoint(
        positions=[where] * len(JOINTS),
        velocities=[1e-4 if index < count - 1 else 0.0] * len(JOINTS),
        time_from_start=Duration(sec=seconds, nanosec=hundredths * 10_000_000),
    )


def main() -> None:
    """Do the one job that the arguments name."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("job", choices=["watch", "pictures", "goal"])
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--points", type=int, default=100_000)
    parser.add_argument("--action", default="/joint_trajectory_controller/follow_joint_trajectory")
    arguments = parser.parse_args()
    # Now and then a client hangs in Fast DDS where another one was killed.
    faulthandler.dump_traceback_later(arguments.seconds + GRACE_S, exit=True)
    rclpy.init()
    node = Node(f"busy_client_{os.getpid()}")
    if arguments.job == "watch":
        watch(node, arguments.seconds)
    elif arguments.job == "pictures":
        look_at_pictures(node, arguments.seconds)
    else:
        send_goal(node, arguments.action, arguments.points, arguments.seconds)
    # The signal that ends the client may have done so, in the midst of this.
    with contextlib.suppress(RuntimeError):
        try_shutdown()


if __name__ == "__main__":
    main()
