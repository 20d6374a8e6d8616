"""Readiness that only another ROS participant can see."""

import os
import signal
from contextlib import suppress
from pathlib import Path

import pytest

pytestmark = pytest.mark.ros

NODE = """
import sys
CODE = '''
import signal, threading
import rclpy
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import String
from std_srvs.srv import Trigger

rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
node = rclpy.create_node("tested")
ended = threading.Event()
signal.signal(signal.SIGINT, lambda *_: ended.set())
print("node is up", flush=True)
BODY
while not ended.is_set():
    rclpy.spin_once(node, timeout_sec=0.02)
node.destroy_node()
rclpy.shutdown()
'''


def tested(body, **options):
    return python("tested", dedent(CODE).replace("BODY", body), **options)


"""


def segments_of(pid: int) -> set[Path]:
    """Return the shared-memory files that a process has open or mapped, none if it has ended."""
    lines: list[str] = []
    links: list[Path] = []
    with suppress(OSError):
        lines = Path(f"/proc/{pid}/maps").read_text().splitlines()
        for link in Path(f"/proc/{pid}/fd").iterdir():
            with suppress(OSError):
                links.append(Path(os.readlink(link)))
    mapped = {Path(line.split()[-1]) for line in lines if "/dev/shm/fastrtps_" in line}
    return mapped | {path for path in links if path.name.startswith("fastrtps_")}


@pytest.mark.parametrize(
    ("body", "condition"),
    [
        ("node.create_publisher(String, 'chat', 1)", "TopicPublished('chat')"),
        (
            "node.create_publisher(String, 'chat', 1)",
            "TopicPublished('/chat', 'std_msgs/msg/String')",
        ),
        (
            "publisher = node.create_publisher(String, 'chat', 1)\n"
            "node.create_timer(0.05, lambda: publisher.publish(String(data='x')))",
            "TopicPublished('/chat', first_message=True)",
        ),
        (
            "from rclpy.qos import DurabilityPolicy, QoSProfile\n"
            "latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)\n"
            "node.create_publisher(String, 'chat', latched).publish(String(data='x'))",
            "TopicPublished('/chat', first_message=True)",
        ),
        (
            "node.create_service(Trigger, 'serve', lambda _, response: response)",
            "ServiceAvailable('serve')",
        ),
        (
            "from control_msgs.action import GripperCommand\n"
            "from rclpy.action import ActionServer\n"
            "result = GripperCommand.Result()\n"
            "server = ActionServer(node, GripperCommand, 'move', lambda _: result)",
            "ActionAvailable('move')",
        ),
    ],
)
def test_a_condition_is_met(launch, body, condition):
    launched = launch(f"{NODE}actions = [tested({body!r}, ready={condition})]")
    launched.wait_for("^ready ")
    launched.process.send_signal(signal.SIGINT)
    assert launched.wait() == 0


def test_output_of_the_middleware_is_not_taken_for_an_answer(launch):
    body = "node.create_publisher(String, 'chat', 1)"
    launched = launch(
        f"{NODE}actions = [tested({body!r}, ready=TopicPublished('chat'))]",
        FASTRTPS_DEFAULT_PROFILES_FILE="/no/such/profile.xml",
    )
    launched.wait_for("XMLPARSER")  # Fast DDS complains on stdout.
    launched.wait_for("^ready ")
    launched.process.send_signal(signal.SIGINT)
    assert launched.wait() == 0


@pytest.mark.parametrize(
    ("condition", "missing"),
    [
        ("TopicPublished('chat', timeout_s=1.0)", "no publisher on topic /chat"),
        ("TopicPublished('/chat', first_message=True, timeout_s=1)", "no message on topic /chat"),
        ("ServiceAvailable('serve', timeout_s=1.0)", "no server of service /serve"),
        ("ActionAvailable('/move', timeout_s=1.0)", "no server of action /move"),
    ],
)
def test_a_condition_that_is_not_met_says_what_is_missing(launch, condition, missing):
    launched = launch(f"{NODE}actions = [tested('pass', ready={condition})]")
    assert launched.wait() == 1
    assert f"tested is not ready after 1 s: {missing}" in launched.own_words[-1]


def test_a_killed_node_leaves_nothing_in_shared_memory(launch, waiting):
    launched = launch(
        f"{NODE}actions = [tested('import os; print(os.getpid(), flush=True)', "
        "ready=LogLine(r'^\\d+$'), on_exit=Shutdown())]"
    )
    pid = int(launched.wait_for(r"^\[tested\] \d+$").split()[1])
    launched.wait_for("^ready ")
    owned = segments_of(pid)
    assert owned
    os.kill(pid, signal.SIGKILL)
    assert launched.wait() == 128 + signal.SIGKILL
    assert not held_by_nobody(owned)


@pytest.mark.parametrize("front_too", [False, True])
def test_a_killed_supervisor_leaves_nothing_in_shared_memory(launch, waiting, front_too):
    launched = launch(
        f"{NODE}actions = [tested('import os; print(os.getpid(), flush=True)', "
        "ready=LogLine(r'^\\d+$'))]"
    )
    pid = int(launched.wait_for(r"^\[tested\] \d+$").split()[1])
    launched.wait_for("^ready ")
    launched.wait_for("node is up")
    owned = segments_of(pid)
    assert owned
    supervisor = int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])
    if front_too:
        launched.process.send_signal(signal.SIGSTOP)
    os.kill(supervisor, signal.SIGKILL)
    waiting.until(lambda: not waiting.running(pid), "the end of the node")
    if front_too:
        launched.process.send_signal(signal.SIGKILL)
    assert launched.wait() == (-signal.SIGKILL if front_too else 128 + signal.SIGKILL)
    if front_too:  # Then the next process removes it.
        assert any(path.exists() for path in owned)
        assert launch("actions = [python('a', 'pass')]").wait() == 0
    if held_by_nobody(owned):  # Another process that held it then has ended meanwhile.
        assert launch("actions = [python('a', 'pass')]").wait() == 0
    assert not held_by_nobody(owned)


def held_by_nobody(segments: set[Path]) -> set[Path]:
    """Return the segments that exist and that no living process has mapped.

    But for the ports from 7000 on: they are those of other domains, too, whose processes may hold
    them or have been killed.
    """
    own = {path for path in segments if not path.name.startswith("fastrtps_port70")}
    mapped = set().union(*(segments_of(pid) for pid in living()))
    # Looked at last: who held one then may have removed it at its end.
    return {path for path in own - mapped if path.exists()}


def living() -> list[int]:
    """Return the processes whose /proc entries are readable."""
    return [int(name) for name in os.listdir("/proc") if name.isdigit()]
