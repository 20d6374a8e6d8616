"""LOCALHOST excludes other hosts: two network namespaces with a cable between them."""

import os
import shutil
import signal
import subprocess
import sys
import textwrap
import time
from collections.abc import Callable, Iterator

import pytest
from programs import Program

from arm_cli.doctor.diagnosis import Severity
from arm_cli.doctor.network import check_listening
from arm_cli.domain_programs import find_listeners
from launch_py.system.dds_profile import shipped_profile

HERE, THERE = "10.77.0.1", "10.77.0.2"
TIMEOUT_S = 90.0

OWN_NODE = """
import rclpy
from std_msgs.msg import Empty
rclpy.init()
node = rclpy.create_node("own")
publisher = node.create_publisher(Empty, "own_topic", 1)
node.create_timer(0.05, lambda: publisher.publish(Empty()))
print("own node runs", flush=True)
rclpy.spin(node)
"""

LAUNCH_FILE = """
import sys
from launch_py import ExecuteProcess, LaunchDescription

def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=[sys.executable, "-c", {own!r}])])
"""

OPEN_NODE = OWN_NODE.replace("own", "open")
"""A node with default settings; receiving from it proves the cable and the discovery."""

INTRUDER = """
import time
import rclpy
from sensor_msgs.msg import JointState
from std_msgs.msg import Empty, Float64MultiArray
rclpy.init()
node = rclpy.create_node("intruder")
heard = {"open": 0, "own": 0, "joints": 0}
def count(name):
    def callback(_message):
        heard[name] += 1
    return callback
node.create_subscription(Empty, "open_topic", count("open"), 1)
node.create_subscription(Empty, "own_topic", count("own"), 1)
node.create_subscription(JointState, "joint_states", count("joints"), 1)
commands = node.create_publisher(Float64MultiArray, "position_controller/commands", 1)
# The open node is heard within a second; all others had forty announcements' time by its 100th.
end = time.monotonic() + 60.0
while heard["open"] < 100 and time.monotonic() < end:
    rclpy.spin_once(node, timeout_sec=1.0)
heard["commands"] = commands.get_subscription_count()
print(heard["open"] >= 100, heard, node.get_node_names())
node.destroy_node()
rclpy.shutdown()
"""

ECHO = f"""
import socket
own = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
own.bind(("{HERE}", 7))
print("echo runs", flush=True)
while True:
    own.sendto(*own.recvfrom(64))
"""

ASK_FOR_ECHO = f"""
import socket
own = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
own.settimeout(0.2)
for _ in range(100):
    try:
        own.sendto(b"echo", ("{HERE}", 7))
        own.recvfrom(64)
    except OSError:
        continue
    raise SystemExit(0)
raise SystemExit("no datagram comes back")
"""


def can_make_hosts() -> bool:
    """Return whether this user may make network namespaces, and has the programs for it."""
    if not all(map(shutil.which, ("ip", "unshare", "nsenter"))):
        return False
    trial = ["unshare", "--net", "--mount", "ip", "link", "set", "lo", "up"]
    return subprocess.run(trial, capture_output=True, check=False).returncode == 0


class Host:
    """A network namespace with shared memory of its own, as another host or container has."""

    def __init__(self, address: str) -> None:
        holder = ["unshare", "--net", "--mount", "sh", "-c"]
        ready = "mount -t tmpfs tmpfs /dev/shm && ip link set lo up && echo ready && exec sleep inf"
        self.address = address
        self._holder = subprocess.Popen([*holder, ready], stdout=subprocess.PIPE, text=True)
        assert self._holder.stdout is not None
        assert self._holder.stdout.readline() == "ready\n"
        self.pid = self._holder.pid

    def inside(self, command: list[str]) -> list[str]:
        """Return the command that runs another one on this host."""
        return ["nsenter", "--net", "--mount", "--target", str(self.pid), *command]

    def close(self) -> None:
        """Remove the host."""
        self._holder.kill()
        self._holder.wait()
        if self._holder.stdout is not None:
            self._holder.stdout.close()


def _run(*command: str) -> str:
    done = subprocess.run(command, check=True, capture_output=True, text=True, timeout=TIMEOUT_S)
    return done.stdout


def _wait_until_running(host: Host, end: str) -> None:
    """Block until the kernel reports the interface as running; before, Fast DDS ignores it."""
    state = ["ip", "-oneline", "link", "show", "dev", end]
    deadline_s = time.monotonic() + TIMEOUT_S
    while "state UP" not in _run(*host.inside(state)):
        assert time.monotonic() < deadline_s, f"the interface {end} does not run"


def _expect_datagrams(here: Host, there: Host) -> None:
    """Prove the cable without ROS: a plain datagram crosses and comes back."""
    echo = Program(here.inside([sys.executable, "-c", ECHO]))
    try:
        echo.wait_for_line("echo runs")
        _run(*there.inside([sys.executable, "-c", ASK_FOR_ECHO]))
    finally:
        echo.close(signal.SIGKILL)


@pytest.fixture
def hosts() -> Iterator[tuple[Host, Host]]:
    """Yield two connected hosts."""
    here, there = Host(HERE), Host(THERE)
    try:
        name, peer = f"a{os.getpid()}", f"b{os.getpid()}"
        ends = ("ip", "link", "add", name, "netns", str(here.pid), "type", "veth", "peer")
        _run(*ends, "name", peer, "netns", str(there.pid))
        for host, end in ((here, name), (there, peer)):
            _run(*host.inside(["ip", "address", "add", f"{host.address}/24", "dev", end]))
            _run(*host.inside(["ip", "link", "set", end, "up"]))
        for host, end in ((here, name), (there, peer)):
            _wait_until_running(host, end)
        _expect_datagrams(here, there)
        yield here, there
    finally:
        here.close()
        there.close()


@pytest.fixture
def background() -> Iterator[Callable[..., Program]]:
    """Start a program, which is interrupted after the test."""
    started: list[Program] = []

    def start(command: list[str], **environment: str) -> Program:
        started.append(Program(command, {**_without_discovery(), **environment}))
        return started[-1]

    yield start
    for program in started:
        program.close()


def _without_discovery() -> dict[str, str]:
    return {k: v for k, v in os.environ.items() if k != "ROS_AUTOMATIC_DISCOVERY_RANGE"}


@pytest.mark.workaround("local_profile")
@pytest.mark.skipif(
    not can_make_hosts(), reason="network namespaces need root, iproute2 and util-linux"
)
def test_another_host_that_names_this_one_receives_and_moves_nothing(hosts, background, tmp_path):
    here, there = hosts
    file = tmp_path / "both.launch.py"
    file.write_text(textwrap.dedent(LAUNCH_FILE).format(own=OWN_NODE))
    arm = [sys.executable, "-m", "arm_cli", "launch"]
    log = {"ROS_LOG_DIR": str(tmp_path)}
    open_node = background(here.inside([sys.executable, "-c", OPEN_NODE]))
    open_node.wait_for_line("open node runs")
    own = background(here.inside([*arm, str(file)]), **log)
    own.wait_for_line("own node runs")
    launched = background(here.inside([*arm, "camera:=none"]), **log)
    launched.wait_until_ready()
    intruder = subprocess.run(
        there.inside([sys.executable, "-c", INTRUDER]),
        # The profile has it ask for 64 participants of the other host, not only for the first four.
        env={**_without_discovery(), "ROS_STATIC_PEERS": HERE, **shipped_profile(os.environ)},
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        check=False,
    )
    heard = f"{intruder.stdout}{intruder.stderr}"
    assert heard.startswith("True {"), heard
    assert "'own': 0, 'joints': 0, 'commands': 0}" in heard


@pytest.mark.workaround("local_profile")
def test_launched_processes_listen_on_loopback_only(launch):
    launched = launch("camera:=front", ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST")
    launched.wait_until_ready()
    listeners = {one.pid: one for one in find_listeners(os.environ)}
    children = {child.pid for child in launched.processes()}
    launched_ones = [one for pid, one in listeners.items() if pid in children]
    assert {"arm_gazebo_node", "robot_state_publisher", "arm_controller_node"} <= {
        one.program for one in launched_ones
    }
    assert all(one.addresses == {"127.0.0.1"} for one in launched_ones)
    assert check_listening(os.environ).severity is Severity.OK
