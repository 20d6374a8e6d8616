"""A process whose new port was removed makes its node again, and then hears what is sent."""

import os
import subprocess
import sys

import pytest

from arm_node.workarounds.lost_ports import lost_ports

pytestmark = pytest.mark.workaround("lost_ports")


@pytest.fixture
def process(tmp_path):
    """The folder of a process that reads a port in a folder of the test's own."""
    (tmp_path / "fd").mkdir()
    port = tmp_path / "fastrtps_port7411"
    port.touch()

    def write(inode, lock=f"{port}_el", suffix=""):
        link = tmp_path / "fd" / "9"
        link.unlink(missing_ok=True)
        link.symlink_to(lock)
        line = f"7f3a-7f3b rw-s 00000000 00:1a {inode}    {port}{suffix}\n"
        (tmp_path / "maps").write_text(f"7f00-7f01 r--p 0 fe:00 7 /usr/lib/a b.so\n{line}")
        return lost_ports(str(tmp_path))

    return port, write


def test_a_port_that_has_its_name_is_not_lost(process):
    port, lost = process
    assert lost(port.stat().st_ino) == []


def test_a_port_that_was_replaced_is_lost(process):
    port, lost = process
    assert lost(port.stat().st_ino + 1, suffix=" (deleted)") == [str(port)]


def test_a_port_that_was_removed_is_lost(process):
    port, lost = process
    inode = port.stat().st_ino
    port.unlink()
    assert lost(inode, suffix=" (deleted)") == [str(port)]


def test_a_port_whose_lock_was_removed_is_lost(process):
    port, lost = process
    assert lost(port.stat().st_ino, lock=f"{port}_el (deleted)") == [str(port)]


def test_ports_to_which_this_process_only_sends_do_not_count(process, tmp_path):
    _, lost = process
    assert lost(1, lock="/dev/null") == []


def test_an_unreadable_process_has_lost_nothing(tmp_path):
    assert lost_ports(str(tmp_path / "none")) == []


MAKE_A_NODE = """
import os, re, sys
import rclpy
from arm_node.workarounds.discovery import first_node
from arm_node.workarounds.lost_ports import lost_ports
from std_msgs.msg import String

def own_ports():
    links = (os.readlink(f"/proc/self/fd/{fd}") for fd in os.listdir("/proc/self/fd")
             if os.path.islink(f"/proc/self/fd/{fd}"))
    return [m[1] for m in map(re.compile(r"(/dev/shm/fastrtps_port\\d+)_el").fullmatch, links) if m]

def make():
    node = rclpy.create_node("listener")
    made.append(node)
    if len(made) <= int(sys.argv[1]):
        for port in own_ports():
            os.unlink(port)
    return node

rclpy.init()
made = []
node = first_node(make)
heard = []
node.create_subscription(String, "said", heard.append, 1)
print("made", len(made), "lost", len(lost_ports()), flush=True)
while not heard:
    rclpy.spin_once(node, timeout_sec=1.0)
print(heard[0].data, flush=True)
sys.stdin.read()
node.destroy_node()
rclpy.shutdown()
"""

SAY = """
import rclpy, time
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("speaker")
publisher = node.create_publisher(String, "said", 1)
while True:
    publisher.publish(String(data="hello"))
    time.sleep(0.05)
"""


@pytest.mark.ros
@pytest.mark.timeout(200)
def test_a_node_whose_ports_were_removed_is_made_again_and_hears():
    with subprocess.Popen([sys.executable, "-c", SAY]) as speaker:
        try:
            with subprocess.Popen(
                [sys.executable, "-c", MAKE_A_NODE, "2"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            ) as listener:
                try:
                    assert listener.stdout is not None
                    assert listener.stdout.readline() == "made 3 lost 0\n"
                    assert listener.stdout.readline() == "hello\n"
                    listener.communicate("", timeout=60)
                finally:
                    listener.kill()
        finally:
            speaker.kill()


@pytest.mark.ros
def test_a_node_that_loses_its_ports_every_time_is_kept_in_the_end():
    result = subprocess.run(
        [sys.executable, "-c", MAKE_A_NODE.partition("heard = []")[0] + "print(len(made))", "9"],
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ},
        check=True,
    )
    assert result.stdout == "5\n"
