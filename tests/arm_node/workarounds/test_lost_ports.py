"""A process whose new port was removed makes its node again, and then hears what is sent."""

import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from arm_node.workarounds.lost_ports import lost_ports

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


def lose_ports(times: int, listen_s: float) -> str:
    script = Path(__file__).with_name("lose_ports.py")
    command = [sys.executable, str(script), str(times), str(listen_s)]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, timeout=180, check=True)
    return done.stdout


@pytest.mark.ros
@pytest.mark.timeout(200)
def test_a_node_whose_ports_were_removed_is_made_again_and_hears():
    assert lose_ports(2, 150.0) == "made 3, lost False\nheard True\n"


@pytest.mark.ros
@pytest.mark.timeout(200)
def test_a_node_that_loses_its_ports_every_time_is_kept_in_the_end():
    assert lose_ports(9, 0.0).startswith("made 5, lost True\n")
