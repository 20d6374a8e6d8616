"""Resets a simulation many times, each time with a goal under way; prints what it saw as JSON.

python resets_client.py COUNT PID
"""

import json
import sys
import time
from typing import Any

import psutil
import rclpy
from control_msgs.action import FollowJointTrajectory
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.task import Future
from simulation_interfaces.srv import ResetSimulation
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

EVERY = 20
"""Resets from one sample, and one goal that may reach its end, to the next."""
WARM_UP = 50
SUCCEEDED, ABORTED = 4, 6
TIMEOUT_S = 30.0


class ResettingNode(Node):
    """Sends goals and resets the simulation."""

    def __init__(self) -> None:
        super().__init__("resets_client")
        self._reset = self.create_client(ResetSimulation, "/reset_simulation")
        self._action = ActionClient(
            self, FollowJointTrajectory, "/joint_trajectory_controller/follow_joint_trajectory"
        )
        self._reset.wait_for_service(TIMEOUT_S)
        self._action.wait_for_server(TIMEOUT_S)
        # What is sent in the moment after a match may be lost.
        time.sleep(2.0)

    def start(self, seconds: float) -> Any:
        """Start a trajectory, and wait until it moves the arm; return the future of its result."""
        point = JointTrajectoryPoint(positions=[0.3, 0.2, 0.1, 0.0])
        point.time_from_start.sec, point.time_from_start.nanosec = divmod(int(seconds * 1e9), 10**9)
        names = ["j0", "j1", "j2", "j3"]
        goal = FollowJointTrajectory.Goal(
            trajectory=JointTrajectory(joint_names=names, points=[point])
        )
        moving = Future()
        sent = self._action.send_goal_async(
            goal, lambda _: moving.done() or moving.set_result(None)
        )
        pending = self._wait_for(sent).get_result_async()
        # A goal is accepted some moments before it starts, and a reset in between does not end it.
        self._wait_for(moving)
        return pending

    def status_of(self, pending: Any) -> int:
        """Return the status with which a goal ends."""
        return self._wait_for(pending).status

    def reset(self) -> float:
        """Reset everything; return how long that took, in ms."""
        start_s = time.perf_counter()
        answer = self._wait_for(self._reset.call_async(ResetSimulation.Request()))
        assert answer.result.result == 1, answer.result.error_message
        return (time.perf_counter() - start_s) * 1e3

    def _wait_for(self, future: Any) -> Any:
        rclpy.spin_until_future_complete(self, future, timeout_sec=TIMEOUT_S)
        assert future.done(), "no answer"
        return future.result()


def main() -> None:
    """Reset, and print what was seen."""
    count, process = int(sys.argv[1]), psutil.Process(int(sys.argv[2]))
    rclpy.init()
    node = ResettingNode()
    seen: dict[str, Any] = {"every": EVERY, "aborted": 0, "succeeded": 0, "sent": 0}
    seen |= {"reset_ms": [], "memory_mb": [], "threads": [], "files": []}
    for number in range(-WARM_UP, count):
        pending = node.start(100.0)
        took_ms = node.reset()
        is_aborted = node.status_of(pending) == ABORTED
        if number < 0:
            continue
        seen["reset_ms"].append(took_ms)
        seen["aborted"] += is_aborted
        if number % EVERY == 0:
            seen["sent"] += 1
            seen["succeeded"] += node.status_of(node.start(0.3)) == SUCCEEDED
            seen["memory_mb"].append(process.memory_info().rss / 1e6)
            seen["threads"].append(process.num_threads())
            seen["files"].append(process.num_fds())
    print(json.dumps(seen), flush=True)
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
