"""move_group over ROS: how soon it is ready, what it costs, how long its answers take.

`arm launch mycobot` starts with and without `planning:=true`, in turns. Then a client with an
executor thread asks for free motions to and fro, and in turn for an answer that needs no plan,
`check_state_validity`. What rclpy itself takes for that: the same service of a plain node that
`rclpy.spin` serves, whose answer is empty; and `get_parameters`, whose messages are smaller.

    python benchmarks/move_group.py
"""

import argparse
import contextlib
import subprocess
import sys
import threading
import time
from collections.abc import Iterator

import harness
import numpy as np

LAUNCH = ("mycobot", "planning:=true")
PLAIN = "/plain/check_state_validity"
SAME = "the same of a plain node, empty"
TARGETS = {
    "plan_kinematic_path": "8, 25 ms",
    "move_action, plan only": "20 ms",
    "check_state_validity": "",
    SAME: "",
    "rclpy's get_parameters": "",
}
JOINTS = ("link1_to_link2", "link2_to_link3", "link3_to_link4")


def wait(future):
    """Return what a future brings; another thread spins the node."""
    done = threading.Event()
    future.add_done_callback(lambda _: done.set())
    done.wait(30)
    return future.result()


def serve_plainly() -> None:
    """Serve check_state_validity with empty answers until the process is ended."""
    import rclpy
    from moveit_msgs.srv import GetStateValidity
    from rclpy.executors import ExternalShutdownException

    rclpy.init()
    node = rclpy.create_node("plain")
    node.create_service(GetStateValidity, PLAIN, lambda _, answer: answer)
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)


@contextlib.contextmanager
def plain_server() -> Iterator[None]:
    """Let a process serve plainly."""
    command = [sys.executable, __file__, "--serve"]
    with subprocess.Popen(command, env=harness.client_environment()) as process:
        try:
            yield
        finally:
            process.terminate()


def client(node, kind, name):
    made = node.create_client(kind, name)
    made.wait_for_service(10)
    return made


class Asker:
    """Asks the nodes in turn, and notes how long each answer takes."""

    def __init__(self, node, executor) -> None:
        from moveit_msgs.action import MoveGroup
        from moveit_msgs.srv import GetMotionPlan, GetStateValidity
        from rcl_interfaces.srv import GetParameters
        from rclpy.action.client import ActionClient

        self._executor = executor
        self._services = {
            "plan_kinematic_path": client(node, GetMotionPlan, "/plan_kinematic_path"),
            "check_state_validity": client(node, GetStateValidity, "/check_state_validity"),
            SAME: client(node, GetStateValidity, PLAIN),
            "rclpy's get_parameters": client(node, GetParameters, "/move_group/get_parameters"),
        }
        self._action = ActionClient(node, MoveGroup, "/move_action")
        self._action.wait_for_server(10)
        self.times = {name: [] for name in TARGETS}

    def call(self, name: str, request):
        return self._timed(name, lambda: wait(self._services[name].call_async(request)))

    def act(self, goal):
        async def act():
            return await (await self._action.send_goal_async(goal)).get_result_async()

        # An action's client may lose an answer that another thread reads before it is noted.
        return self._timed("move_action, plan only", lambda: wait(self._executor.create_task(act)))

    def _timed(self, name: str, ask):
        start = time.perf_counter()
        answer = ask()
        self.times[name].append(time.perf_counter() - start)
        return answer


def ask_in_turn(asker: Asker, count: int) -> None:
    from moveit_msgs.action import MoveGroup
    from moveit_msgs.srv import GetMotionPlan, GetStateValidity
    from rcl_interfaces.srv import GetParameters

    from arm_planning.ros.goal_messages import joint_goal, plan_message

    random = np.random.default_rng(0)
    for _ in range(count):
        goal = joint_goal(dict(zip(JOINTS, random.uniform(-0.4, 0.4, 3).tolist(), strict=True)))
        message = plan_message("arm", goal, allowed_planning_time=5.0, num_planning_attempts=1)
        message.max_velocity_scaling_factor = message.max_acceleration_scaling_factor = 1.0
        request = GetMotionPlan.Request(motion_plan_request=message)
        answer = asker.call("plan_kinematic_path", request)
        assert answer.motion_plan_response.error_code.val == 1
        only = MoveGroup.Goal(request=message)
        only.planning_options.plan_only = True
        only.planning_options.planning_scene_diff.is_diff = True
        assert asker.act(only).result.error_code.val == 1
        for name in ("check_state_validity", SAME):
            asker.call(name, GetStateValidity.Request(group_name="arm"))
        asker.call("rclpy's get_parameters", GetParameters.Request(names=["use_sim_time"]))


def answers(count: int) -> dict[str, np.ndarray]:
    """Return the seconds of each answer, by what was asked for."""
    import rclpy
    from rclpy.executors import SingleThreadedExecutor

    rclpy.init()
    node = rclpy.create_node("measuring")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    spinning = threading.Thread(target=executor.spin)
    spinning.start()
    asker = Asker(node, executor)
    ask_in_turn(asker, count)
    executor.shutdown()
    spinning.join()
    node.destroy_node()
    rclpy.shutdown()
    return {name: np.array(values) for name, values in asker.times.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--runs", type=int, default=3, help="starts of each kind")
    parser.add_argument("--count", type=int, default=200, help="requests of each kind")
    parser.add_argument("--serve", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.serve:
        serve_plainly()
        return
    starts: dict[tuple[str, ...], list[tuple[float, float]]] = {LAUNCH[:1]: [], LAUNCH: []}
    for _ in range(options.runs):
        for words, found in starts.items():
            with harness.started(*words) as running:
                ready_s = time.monotonic() - running.started_s
                time.sleep(harness.SETTLED_S)
                found.append((ready_s, running.memory_mb()))
    (alone_s, alone_mb), (both_s, both_mb) = (np.median(each, axis=0) for each in starts.values())
    with harness.started(*LAUNCH), plain_server():
        times = answers(options.count)
    rows = [
        harness.Row(
            "ready, without planning and with it", f"{alone_s:.2f}, {both_s:.2f} s", "1.5 s"
        ),
        harness.Row("memory that planning adds (Pss)", f"{both_mb - alone_mb:.0f} MB", "120 MB"),
    ]
    for name, values in times.items():
        p50, p99 = harness.percentiles(values * 1e3, 50, 99)
        rows.append(harness.Row(f"{name}: p50, p99", f"{p50:.1f}, {p99:.1f} ms", TARGETS[name]))
    own, plain = (np.median(times[name]) for name in ("check_state_validity", SAME))
    rows.append(
        harness.Row("check_state_validity, of a plain node's time", f"{own / plain:.2f} x", "1.3 x")
    )
    harness.print_table("move_group over ROS", rows)


if __name__ == "__main__":
    main()
