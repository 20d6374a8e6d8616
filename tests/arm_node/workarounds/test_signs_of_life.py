"""The pause between signs of life, written into ports as Fast DDS makes them and nowhere else."""

import os
import struct

import pytest
from run_python import run_python

from arm_node.workarounds.ports import PAUSE_MS, shorten_liveness_pause

pytestmark = pytest.mark.workaround("signs_of_life")

PORT = 7411


def port(*numbers: int, before: bytes = bytes(260)) -> bytes:
    return before + struct.pack(f"={len(numbers)}I", *numbers) + bytes(400)


@pytest.fixture
def write(tmp_path):
    """Write a file of shared memory that this process has open, or only its lock."""
    links = tmp_path / "fd"
    links.mkdir()

    def write(content: bytes | None, name: str = f"fastrtps_port{PORT}", lock: str = "_el") -> str:
        path = tmp_path / name
        if content is not None:
            path.write_bytes(content)
        (links / str(len(os.listdir(links)))).symlink_to(f"{path}{lock}")
        return str(path)

    return write


@pytest.fixture
def process(tmp_path):
    return str(tmp_path)


def test_the_pause_is_shortened_and_nothing_else(write, process):
    path = write(port(PORT, 1, 1000, 333, 512))
    assert shorten_liveness_pause(process) == [path]
    with open(path, "rb") as file:
        assert file.read() == port(PORT, 1, 1000, PAUSE_MS, 512)


def test_the_number_of_the_port_may_be_in_another_place(write, process):
    before = bytes(30) + struct.pack("=I", PORT) + bytes(90)
    path = write(port(PORT, 1, 1000, 333, 512, before=before))
    shorten_liveness_pause(process)
    with open(path, "rb") as file:
        assert file.read() == port(PORT, 1, 1000, PAUSE_MS, 512, before=before)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        port(PORT, 1, 1000, PAUSE_MS, 512),
        port(PORT, 1, 60, 20, 512),
        port(PORT, 1, 1000, 250, 512),
        port(PORT + 1, 1, 1000, 333, 512),
        port(PORT, 1, 1000, 333, 512)[: 260 + 12],
    ],
    ids=["empty", "short already", "shorter", "another layout", "another port", "cut"],
)
def test_what_is_not_as_expected_is_left_alone(write, process, content):
    path = write(content)
    assert shorten_liveness_pause(process) == []
    with open(path, "rb") as file:
        assert file.read() == content


def test_ports_of_others_are_left_alone(write, process):
    content = port(PORT, 1, 1000, 333, 512)
    path = write(content, lock="_sl")
    assert shorten_liveness_pause(process) == []
    with open(path, "rb") as file:
        assert file.read() == content


def test_a_missing_port_is_not_an_error(write, process, tmp_path):
    write(None)
    assert shorten_liveness_pause(process) == []
    assert shorten_liveness_pause(str(tmp_path / "nowhere")) == []


NUMBERS = """
import os, struct
from arm_node.workarounds.local_profile import use_local_profile
use_local_profile(os.environ)
import rclpy
from arm_node.workarounds.discovery import prompt_discovery
from arm_node.workarounds.ports import read_ports
rclpy.init()
with prompt_discovery():
    node = rclpy.create_node("alive")
for port in read_ports():
    head = open(port, "rb").read(4096)
    at = head.find(struct.pack("=I", int(port.rpartition("port")[2])))
    print(*struct.unpack_from("=4I", head, at)[2:])
node.destroy_node()
rclpy.shutdown()
"""


@pytest.mark.ros
def test_fast_dds_has_the_numbers_where_they_are_looked_for():
    done = run_python("-c", NUMBERS, check=True)
    numbers = done.stdout.splitlines()
    assert len(numbers) >= 2
    assert set(numbers) == {f"1000 {PAUSE_MS}"}
