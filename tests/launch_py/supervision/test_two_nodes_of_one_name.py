"""A node whose name is already on the ROS graph is not started; real nodes, no simulation."""

import os
import re
import signal

import pytest

pytestmark = pytest.mark.ros

NODE = """
CODE = '''
import os, signal, sys, threading
import rclpy
from rclpy.signals import SignalHandlerOptions

rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
node = rclpy.create_node("nameless")
ended = threading.Event()
signal.signal(signal.SIGINT, lambda *_: ended.set())
print("up as", node.get_fully_qualified_name(), os.getpid(), flush=True)
while not ended.is_set():
    rclpy.spin_once(node, timeout_sec=0.02)
node.destroy_node()
rclpy.shutdown()
'''


def tested(exec_name, **options):
    return Node(
        executable=sys.executable,
        arguments=["-c", dedent(CODE)],
        exec_name=exec_name,
        ready=LogLine("^up as"),
        **options,
    )


"""
OLD = f"{NODE}actions = [tested('old', name='arm', namespace='left')]"
NEW = f"{NODE}actions = [forever('other'), tested('new', name='arm', namespace='left')]"


@pytest.fixture
def old(launch):
    """A launch whose node is on the graph."""
    launched = launch(OLD)
    launched.wait_for("^ready ")
    return launched


def test_a_second_node_with_the_same_name_is_not_started(launch, old):
    second = launch(NEW)
    assert second.wait() == 1
    (said,) = second.own_words
    assert re.search(
        r"failed with exit code 1: /left/arm is already on the ROS graph, from process \d+: ", said
    )
    assert "replace:=true" in said
    old.process.send_signal(signal.SIGINT)
    assert old.wait() == 0


def test_replace_replaces_the_first_node(launch, old, waiting):
    second = launch(NEW, "replace:=true")
    second.wait_for("^ready ")
    said = second.wait_for("^.launch. ending process .*: this launch replaces /left/arm")
    assert not waiting.running(int(re.findall("[0-9]+", said)[0]))
    assert old.wait() == 0
    old.wait_for("old ended with exit code 0")
    second.process.send_signal(signal.SIGINT)
    assert second.wait() == 0


def test_a_node_that_names_itself_is_detected_once_it_appears(launch):
    first = launch(f"{NODE}actions = [tested('old')]")
    first.wait_for("^ready ")
    second = launch(f"{NODE}actions = [tested('new')]")
    assert second.wait() == 1
    assert "/nameless is already on the ROS graph, from process" in second.own_words[-1]
    second.wait_for("new stopped")
    first.process.send_signal(signal.SIGINT)
    assert first.wait() == 0


def test_a_node_that_crashes_beside_others_is_restarted(launch, old):
    restart = "RestartPolicy('on-failure', first_delay_s=0.0)"
    launched = launch(f"{NODE}actions = [tested('crashing', name='b', restart={restart})]")
    pid = int(launched.wait_for("up as /b").split()[-1])
    os.kill(pid, signal.SIGKILL)
    launched.wait_for("up as /b", count=2)
    launched.process.send_signal(signal.SIGINT)
    assert launched.wait() == 0
