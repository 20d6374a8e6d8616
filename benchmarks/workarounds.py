"""The benefit of each workaround: figures with it and, alternately, with ARM_WITHOUT naming it.

A workaround that does not improve a figure that users notice by a tenth has no place in the suite.
Of local_profile and private_files, what they prevent is counted. Nothing here provokes the faults
of the libraries that torn_ports, lost_ports and parameter_types answer, and patch_releases takes
a file of another MuJoCo.
"""

import argparse
import contextlib
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import as_fast_as_possible
import harness
import numpy as np
import start_up
import trajectory_control

from arm_node.workarounds.switch import LIBRARIES, OF_THE_BUILD, VARIABLE

FOLDER = Path(__file__).parent
INTERFACES = FOLDER.parent / "arm_interfaces"
RATE_HZ = 500
SECONDS = 5.0
WAY_POINTS = 100_000
WAIT_FOR_TEXT = """
import os, time
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("waiting")
latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
arrivals_s = []
node.create_subscription(String, "text", lambda _: arrivals_s.append(time.monotonic()), latched)
print("waiting", flush=True)
while not arrivals_s:
    rclpy.spin_once(node)
print(arrivals_s[0], flush=True)
os._exit(0)
"""
PUBLISH_TEXT = """
import os, sys, time
from arm_node.environment import prepare_environment
prepare_environment()
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String
from arm_node.workarounds.discovery import prompt_discovery
rclpy.init()
print(time.monotonic(), flush=True)
with prompt_discovery():
    node = rclpy.create_node("publisher")
latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
publisher = node.create_publisher(String, "text", latched)
publisher.publish(String(data="text"))
sys.stdin.read()
os._exit(0)
"""
MEASURE_A_PERIOD = """
import physics_speed
bench = physics_speed.Bench(100.0, "empty")
print(physics_speed.best_us(bench.tick))
"""
PLAIN_NODE = """
from arm_node.environment import prepare_environment
prepare_environment()
import os, time
import rclpy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
rclpy.init()
node = rclpy.create_node("plain")
node.create_subscription(JointState, "joint_states", print, 1)
publisher = node.create_publisher(Float64MultiArray, "commands", 1)
print(time.process_time(), flush=True)
os._exit(0)
"""


@dataclass(frozen=True, slots=True)
class Figure:
    """Something that users notice.

    Attributes:
        what: the figure.
        unit: of what `measure` returns.
        measure: measures it once, with the workarounds of this process's environment.
        of: the workarounds that affect it.
    """

    what: str
    unit: str
    measure: Callable[[], float]
    of: tuple[str, ...]


def late_client_s() -> float:
    """Return the time from a late client's node to its first joint state."""
    return max(start_up.late_clients(5))


def new_node_s() -> float:
    """Return the time from a new node, without the launcher, to its message at a subscriber."""
    with harness.fresh_domain():
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        command, environment = [sys.executable, "-c"], harness.client_environment()
        waiting = subprocess.Popen([*command, WAIT_FOR_TEXT], env=environment, **pipes)
        waiting.stdout.readline()
        # The subscriber's own announcements become rare.
        time.sleep(1.0)
        publisher = subprocess.Popen([*command, PUBLISH_TEXT], env=environment, **pipes)
        started_s = float(publisher.stdout.readline())
        arrived_s = float(waiting.stdout.readline())
        publisher.communicate()
        waiting.communicate()
    return arrived_s - started_s


def period_us() -> float:
    """Return the shortest time of a control period of the arm without ROS; see physics_speed.py."""
    command = [sys.executable, "-c", MEASURE_A_PERIOD]
    done = subprocess.run(command, cwd=FOLDER, stdout=subprocess.PIPE, text=True, check=True)
    return float(done.stdout)


def open_sockets() -> float:
    """Return how many UDP sockets of the simulation listen on every network interface."""
    with harness.suite("camera:=none") as running:
        connections = running.find("arm_gazebo_node").net_connections(kind="udp4")
        return sum(connection.laddr.ip == "0.0.0.0" for connection in connections)


def processor_of(module: str) -> float:
    """Return what a process of the suite takes of a core at 500 Hz, in percent."""
    with harness.suite("camera:=none", rate_hz=RATE_HZ) as running:
        process = running.find(module)
        time.sleep(1.0)
        return harness.cpu_percent(process, SECONDS)


def gap_s() -> float:
    """Return the longest pause of /joint_states around a goal of many way points."""
    with trajectory_control.client("large", "--count", str(WAY_POINTS)) as (_, working):
        working.answer()
        states = harness.Client("record", "--seconds", "20")
        arrivals = np.array(states.answer()["arrivals_s"])
        states.stop()
        if not working.answer()["accepted"]:
            raise SystemExit("the large goal was refused")
    return float(np.diff(arrivals).max())


def command_s() -> float:
    """Return how long `arm topic echo --once` takes beside a simulation, the median of 5."""
    command = [sys.executable, "-m", "arm_cli", "topic", "echo", "--once", "/joint_states"]
    times_s = []
    with harness.suite("camera:=none"):
        for _ in range(5):
            started_s = time.monotonic()
            subprocess.run(
                command, env=harness.client_environment(), capture_output=True, check=True
            )
            times_s.append(time.monotonic() - started_s)
    return statistics.median(times_s)


def readable_files() -> float:
    """Return how many files of the suite in shared memory every user of the machine may read."""
    before = set(os.listdir("/dev/shm"))
    with harness.suite("camera:=none"):
        ours = [Path("/dev/shm", name) for name in set(os.listdir("/dev/shm")) - before]
        return sum(bool(path.stat().st_mode & 0o044) for path in ours if path.exists())


def plain_node_s() -> float:
    """Return the processor time of a process up to its node's first topic."""
    said = subprocess.run(
        [sys.executable, "-c", PLAIN_NODE], check=True, capture_output=True
    ).stdout
    return float(said)


def build_s() -> float:
    """Return how long pip takes to build arm_interfaces."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", folder]
        started_s = time.monotonic()
        subprocess.run([*command, str(INTERFACES)], check=True)
        return time.monotonic() - started_s


FIGURES = {
    "node": Figure(
        "new node without the launcher to its message at a waiting subscriber",
        "s",
        new_node_s,
        ("discovery",),
    ),
    "late": Figure(
        "late client: node to first /joint_states, longest of 5",
        "s",
        late_client_s,
        ("signs_of_life",),
    ),
    "period": Figure("control period at 100 Hz without ROS", "µs", period_us, ("profiler",)),
    "simulation": Figure(
        f"processor of the simulation at {RATE_HZ} Hz",
        "%",
        lambda: processor_of("arm_gazebo_node"),
        ("message_template", "stamp_clock", "process_clock"),
    ),
    "publisher": Figure(
        f"processor of robot_state_publisher at {RATE_HZ} Hz",
        "%",
        lambda: processor_of("robot_state_publisher"),
        ("stamp_clock", "joint_state_encoding"),
    ),
    "factor": Figure(
        "as fast as possible: real-time factor",
        "x",
        lambda: as_fast_as_possible.suite_factor(SECONDS, "use_robot_state_pub:=false"),
        ("message_template",),
    ),
    "gap": Figure(
        f"longest pause of /joint_states around a goal of {WAY_POINTS} way points",
        "s",
        gap_s,
        ("serialized_goals",),
    ),
    "command": Figure(
        "`arm topic echo --once /joint_states`, median of 5", "s", command_s, ("exit_pause",)
    ),
    "sockets": Figure(
        "UDP sockets of the simulation that other hosts reach", "", open_sockets, ("local_profile",)
    ),
    "readable": Figure(
        "files in shared memory that all users may read", "", readable_files, ("private_files",)
    ),
    "plain": Figure(
        "processor time of a plain node up to its first topic",
        "s",
        plain_node_s,
        ("lazy_messages",),
    ),
    "build": Figure("build of arm_interfaces", "s", build_s, OF_THE_BUILD),
}


@contextlib.contextmanager
def without(name: str) -> Iterator[None]:
    """Switch a workaround off in processes that start in this context; "" switches none off."""
    before = os.environ.get(VARIABLE)
    os.environ[VARIABLE] = name
    try:
        yield
    finally:
        os.environ.pop(VARIABLE)
        if before is not None:
            os.environ[VARIABLE] = before


def compare(figure: Figure, name: str, runs: int) -> harness.Row:
    """Measure a figure alternately with and without a workaround."""
    values: dict[str, list[float]] = {"": [], name: []}
    for _ in range(runs):
        for off in values:
            with without(off):
                values[off].append(figure.measure())
                print(
                    f"{figure.what}, without {off or 'none'}: {values[off][-1]:.3g}",
                    file=sys.stderr,
                )
    on, off = (statistics.median(column) for column in values.values())
    share = f"{100 * (off - on) / on:+.0f} %" if on else ""
    measured = f"{on:.3g} {figure.unit}; {off:.3g} {figure.unit}; {share} (n={runs})"
    return harness.Row(f"{name}: {figure.what}; without; change", measured)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--figures", nargs="+", choices=FIGURES, default=list(FIGURES))
    parser.add_argument("--names", nargs="+", choices=[*LIBRARIES, *OF_THE_BUILD])
    arguments = parser.parse_args()
    rows = [
        compare(FIGURES[key], name, arguments.runs)
        for key in arguments.figures
        for name in FIGURES[key].of
        if arguments.names is None or name in arguments.names
    ]
    harness.print_table("Workarounds", rows)


if __name__ == "__main__":
    main()
