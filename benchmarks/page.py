"""The page: what it costs with one client and a camera, and how fast a slider moves the arm.

The client is a socket that reads all that a browser would: a browser's drawing is not the page's.
"""

import contextlib
import random
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator

import harness
import psutil
import rclpy
from page_client import PageClient
from rclpy.executors import ExternalShutdownException
from sensor_msgs.msg import JointState

PORT = 18080
WATCHED_S = 15.0
SWEEP_S = 1.0
STEPS = 40
STEP_RAD = 0.2
NOTICED_RAD = 1e-3


@contextlib.contextmanager
def page() -> Iterator[psutil.Process]:
    """Run the page's node."""
    command = [sys.executable, "-m", "arm_viewer.arm_viewer_node"]
    process = subprocess.Popen([*command, "--ros-args", "-p", f"port:={PORT}"])
    try:
        yield psutil.Process(process.pid)
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(30)


def connected() -> PageClient:
    """Return a client once the page answers."""
    deadline_s = time.monotonic() + 60.0
    while True:
        try:
            return PageClient(PORT)
        except OSError:
            if time.monotonic() > deadline_s:
                raise
            time.sleep(0.1)


def cost(process: psutil.Process, client: PageClient) -> list[harness.Row]:
    """Watch the page's process for some seconds."""
    deadline_s = time.monotonic() + 60.0
    while not client.images:
        if time.monotonic() > deadline_s:
            raise SystemExit("the page shows no image")
        time.sleep(0.1)
    images, received, start_s = client.images, client.received_bytes, time.monotonic()
    process.cpu_percent()
    slider, goal = client.wait_for_slider("j0"), 1.0
    # Of an arm at rest all images are the same, and only the first one is sent.
    while time.monotonic() - start_s < WATCHED_S:
        client.move(slider, goal)
        goal = -goal
        time.sleep(SWEEP_S)
    client.move(slider, 0.0)
    load = process.cpu_percent()
    passed_s = time.monotonic() - start_s
    return [
        harness.Row(
            "page process, one client, camera 320x240, moving arm",
            f"{load:.0f} % of a core",
            "25 %",
        ),
        harness.Row("images shown", f"{(client.images - images) / passed_s:.1f} Hz"),
        harness.Row("sent", f"{(client.received_bytes - received) / passed_s / 1e3:.0f} kB/s"),
        harness.Row("memory", f"{process.memory_info().rss / 1e6:.0f} MB"),
    ]


class Joint:
    """Where j0 is, read from /joint_states in a thread of its own."""

    def __init__(self) -> None:
        """Subscribe."""
        self.position = 0.0
        self._changed = threading.Condition()
        self._node = rclpy.create_node("page_benchmark")
        self._node.create_subscription(JointState, "/joint_states", self._take, 10)
        threading.Thread(target=self._spin, daemon=True).start()

    def time_of_motion(self, origin: float) -> float:
        """Return when the joint was seen to have left a position."""
        with self._changed:
            if not self._changed.wait_for(lambda: abs(self.position - origin) > NOTICED_RAD, 30.0):
                raise SystemExit("the slider does not move the joint")
            return time.monotonic()

    def wait_for_rest(self, goal: float) -> None:
        """Wait until the joint is there."""
        with self._changed:
            if not self._changed.wait_for(lambda: abs(self.position - goal) < NOTICED_RAD, 30.0):
                raise SystemExit(f"the joint does not reach {goal} rad; it is at {self.position}")

    def _take(self, message: JointState) -> None:
        with self._changed:
            self.position = message.position[message.name.index("j0")]
            self._changed.notify_all()

    def _spin(self) -> None:
        with contextlib.suppress(ExternalShutdownException):
            rclpy.spin(self._node)


def latencies_s(client: PageClient) -> list[float]:
    """Move the slider of j0 back and forth; return the time until each motion is seen."""
    slider = client.wait_for_slider("j0")
    joint, phases, goal = Joint(), random.Random(1), 0.0
    measured = []
    # The page looks for controllers once a second, and needs them to know whom to command.
    time.sleep(4.0)
    for _ in range(STEPS):
        joint.wait_for_rest(goal)
        time.sleep(phases.uniform(0.1, 0.2))
        origin, goal = joint.position, STEP_RAD - goal
        sent_s = time.monotonic()
        client.move(slider, goal)
        measured.append(joint.time_of_motion(origin) - sent_s)
    return measured


def main() -> None:
    """Print the table."""
    with harness.suite("camera:=side"), page() as process:
        rclpy.init()
        client = connected()
        rows = cost(process, client)
        p50, p99 = harness.percentiles(latencies_s(client), 50, 99)
        client.close()
        rclpy.try_shutdown()
    rows.append(harness.Row("slider to /joint_states, p50", f"{p50 * 1e3:.1f} ms", "60 ms"))
    rows.append(harness.Row("slider to /joint_states, p99", f"{p99 * 1e3:.1f} ms"))
    harness.print_table("The page in the browser", rows)


if __name__ == "__main__":
    main()
