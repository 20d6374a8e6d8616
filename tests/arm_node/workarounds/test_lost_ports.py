"""Ports whose names lead elsewhere, in a folder of the test's own.

A process whose ports are removed hears nothing from others: here such ports are only looked at.
`test_discovery` has what a process does that has lost its own.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from arm_node.workarounds.ports import lost_ports

pytestmark = pytest.mark.workaround("lost_ports")


@pytest.fixture
def process(tmp_path):
    """The folder of a process that reads a port in a folder of the test's own."""
    with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
        yield _process(tmp_path, Path(folder, "fastrtps_port7411"))


def _process(tmp_path, port):
    (tmp_path / "fd").mkdir()
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


OWN_PORTS = """
import rclpy
from arm_node.workarounds.discovery import first_node
from arm_node.workarounds.ports import lost_ports
from arm_node.workarounds.ports import mapped_files, read_ports
rclpy.init()
node = first_node(lambda: rclpy.create_node("listener"))
ports = read_ports()
print(len(ports) > 1, all(ports.values()), ports.keys() <= mapped_files().keys(), lost_ports())
node.destroy_node()
rclpy.shutdown()
"""


@pytest.mark.ros
def test_the_ports_of_a_node_are_found_and_are_not_lost():
    command = [sys.executable, "-c", OWN_PORTS]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, timeout=60, check=True)
    assert done.stdout == "True True True []\n"
