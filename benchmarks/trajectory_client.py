"""A client of the trajectory controller that does not use the suite. One job in each run.

Prints one JSON line; wall times are CLOCK_MONOTONIC, simulated ones those of message stamps.
"""

import argparse
import json
import math
import random
import time
from collections.abc import Callable
from typing import Any

import rclpy
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTrajectoryControllerState
from controller_manager_msgs.srv import ConfigureController, LoadController, SwitchController
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.action.client import ActionClient
from rclpy.node import Node
from rclpy.utilities import try_shutdown
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

NAME = "joint_trajectory_controller"
JOINTS = ["j0", "j1", "j2", "j3"]
STRICT = 2
DISCOVERY_S = 1.0
"""After a service has appeared: its server may not know of this client yet."""

WAY_POINTS = (
    (0.5, 0.3, 0.2, 0.4),
    (0.8, 0.6, 0.5, -0.2),
    (0.2, 0.4, 0.9, -0.6),
    (-0.5, 0.1, 0.4, 0.2),
    (0.0, 0.0, 0.0, 0.0),
)
SPACING_S = 1.0


class Client:
    """A node with what the jobs need."""

    def __init__(self) -> None:
        rclpy.init()
        self.node = Node("trajectory_client")
        self.action = ActionClient(
            self.node, FollowJointTrajectory, f"/{NAME}/follow_joint_trajectory"
        )
        self._services: dict[str, Any] = {}
        self.states: list[JointTrajectoryControllerState] = []
        self.overruns: list[tuple[float, int]] = []
        self.node.create_subscription(DiagnosticArray, "/diagnostics", self._note, 10)

    def watch_states(self) -> None:
        """Keep the controller's states from now on."""
        self.node.create_subscription(
            JointTrajectoryControllerState, f"/{NAME}/controller_state", self.states.append, 100
        )
        self.spin_until(lambda: bool(self.states))

    def spin_until(self, condition: Callable[[], bool], timeout_s: float = 60.0) -> None:
        """Spin until the condition holds."""
        deadline = time.monotonic() + timeout_s
        while not condition():
            if time.monotonic() > deadline:
                raise SystemExit("timeout")
            rclpy.spin_once(self.node, timeout_sec=0.05)

    def spin_for(self, seconds: float) -> None:
        """Spin for some time."""
        end = time.monotonic() + seconds
        self.spin_until(lambda: time.monotonic() > end)

    def wait(self, future: Any) -> Any:
        """Spin until a future is done; return its result."""
        self.spin_until(future.done)
        return future.result()

    def start_goal(self, points: list[JointTrajectoryPoint]) -> Any:
        """Send a goal; return the future of its result."""
        self.spin_until(self.action.server_is_ready)
        goal = FollowJointTrajectory.Goal(
            trajectory=JointTrajectory(joint_names=JOINTS, points=points)
        )
        handle = self.wait(self.action.send_goal_async(goal))
        if not handle.accepted:
            raise SystemExit("the goal was rejected")
        return handle.get_result_async()

    def call(self, kind: Any, service_name: str, **fields: Any) -> Any:
        """Call a service of the controller manager."""
        if service_name not in self._services:
            service = self.node.create_client(kind, f"/controller_manager/{service_name}")
            self.spin_until(service.service_is_ready)
            self.spin_for(DISCOVERY_S)
            self._services[service_name] = service
        answer = self.wait(self._services[service_name].call_async(kind.Request(**fields)))
        if not answer.ok:
            raise SystemExit(f"{service_name} was refused: {answer}")
        return answer

    def hand_over(self, activate: str, deactivate: str) -> None:
        """Let one controller take the place of another."""
        self.call(
            SwitchController,
            "switch_controller",
            activate_controllers=[activate],
            deactivate_controllers=[deactivate],
            strictness=STRICT,
        )

    def _note(self, message: DiagnosticArray) -> None:
        for status in message.status:
            values = {item.key: item.value for item in status.values}
            if "overruns" in values:
                self.overruns.append((time.monotonic(), int(values["overruns"])))


def point(time_s: float, positions: Any, velocities: Any, accelerations: Any) -> Any:
    """Return a way point."""
    nanoseconds = round(time_s * 1e9)
    return JointTrajectoryPoint(
        positions=list(positions),
        velocities=list(velocities),
        accelerations=list(accelerations),
        time_from_start=Duration(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9),
    )


def seconds(time_: Any) -> float:
    """Return a stamp or duration in seconds."""
    return time_.sec + time_.nanosec * 1e-9


def switch(client: Client, count: int) -> dict:
    """Switch the joints between two controllers; return how long each answer took."""
    phases = random.Random(1)
    names = ["position_controller", NAME]
    latencies = []
    for _ in range(count):
        client.spin_for(phases.uniform(0.02, 0.05))
        called_s = time.monotonic()
        client.hand_over(*names)
        latencies.append(time.monotonic() - called_s)
        names.reverse()
    return {"latencies_s": latencies}


def busy(client: Client, seconds_: float) -> dict:
    """Follow a sine; say how many cycles overran in how many seconds."""
    step_s, omega = 0.1, 2.0
    points = []
    for i in range(1, round((seconds_ + 6.0) / step_s)):
        t = i * step_s
        sine, cosine = 0.3 * math.sin(omega * t), 0.3 * math.cos(omega * t)
        points.append(point(t, [sine] * 4, [omega * cosine] * 4, [-(omega**2) * sine] * 4))
    points.append(point((len(points) + 10) * step_s, [0.0] * 4, [0.0] * 4, [0.0] * 4))
    client.start_goal(points)
    client.spin_for(1.0)
    client.overruns.clear()
    client.spin_until(lambda: bool(client.overruns))
    print(json.dumps({"begun": True}), flush=True)
    client.spin_for(seconds_)
    (begun_s, before), (ended_s, after) = client.overruns[0], client.overruns[-1]
    return {"seconds": ended_s - begun_s, "overruns": after - before}


def track(client: Client) -> dict:
    """Go through the way points; say the error of every joint in every cycle."""
    client.watch_states()
    rest = [0.0] * len(JOINTS)
    rows = [rest, *WAY_POINTS]
    points = []
    for i, positions in enumerate(WAY_POINTS, 1):
        following = rows[i + 1] if i < len(WAY_POINTS) else None
        velocities = (
            [(b - a) / (2 * SPACING_S) for a, b in zip(rows[i - 1], following, strict=True)]
            if following
            else rest
        )
        points.append(point(i * SPACING_S, positions, velocities, rest))
    result = client.start_goal(points)
    client.states.clear()
    answer = client.wait(result).result
    if answer.error_code:
        raise SystemExit(answer.error_string)
    return {"errors_rad": [list(state.error.positions) for state in client.states]}


def results(client: Client, count: int) -> dict:
    """Say how much simulated time passed from the end of each goal to its result."""
    client.watch_states()
    rest = [0.0] * len(JOINTS)
    delays = []
    for i in range(count):
        duration_s = 0.3 + 0.0013 * i
        client.states.clear()
        result = client.start_goal([point(duration_s, [0.1 * (i % 2)] * 4, rest, rest)])
        arrived: list[float] = []
        result.add_done_callback(
            lambda _, arrived=arrived: arrived.append(seconds(client.states[-1].header.stamp))
        )
        client.wait(result)
        client.spin_for(0.1)
        met = next(
            seconds(state.header.stamp)
            for state in client.states
            if seconds(state.reference.time_from_start) >= duration_s - 1e-6
            and seconds(state.reference.time_from_start) < duration_s + 0.1
        )
        delays.append(arrived[0] - met)
    return {"delays_s": delays}


def large(client: Client, count: int) -> dict:
    """Send a goal of so many way points; say whether it was accepted."""
    rest = [0.0] * len(JOINTS)
    points = [point(0.01 * (i + 1), rest, rest, rest) for i in range(count)]
    goal = FollowJointTrajectory.Goal(trajectory=JointTrajectory(joint_names=JOINTS, points=points))
    client.spin_until(client.action.server_is_ready)
    print(json.dumps({"ready": True}), flush=True)
    return {"accepted": client.wait(client.action.send_goal_async(goal)).accepted}


def main() -> None:
    """Do the one job that the arguments name."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("job", choices=["switch", "busy", "track", "results", "large"])
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seconds", type=float, default=20.0)
    arguments = parser.parse_args()
    client = Client()
    client.call(LoadController, "load_controller", name=NAME)
    client.call(ConfigureController, "configure_controller", name=NAME)
    client.hand_over(NAME, "position_controller")
    jobs: dict[str, Callable[[], dict]] = {
        "switch": lambda: switch(client, arguments.count),
        "busy": lambda: busy(client, arguments.seconds),
        "track": lambda: track(client),
        "results": lambda: results(client, arguments.count),
        "large": lambda: large(client, arguments.count),
    }
    print(json.dumps(jobs[arguments.job]()), flush=True)
    client.node.destroy_node()
    try_shutdown()


if __name__ == "__main__":
    main()
