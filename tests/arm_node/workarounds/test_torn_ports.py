"""Shared-memory ports whose creator died before it had filled them.

Fast DDS 2.14.5 waits for ever where it opens one; here they are only looked at, in another folder.
"""

import os
import time
from pathlib import Path

import pytest

from arm_node.workarounds.ports import LEAST_AGE_S, remove_torn_ports

pytestmark = pytest.mark.workaround("torn_ports")

FILLED, BEGUN = b"\x02\0\0\0" + bytes(60), b"\x01\0\0\0" + bytes(60)


def make(folder: Path, name: str, content: bytes = b"", age_s: float = LEAST_AGE_S + 1.0) -> Path:
    path = folder / name
    path.write_bytes(content)
    then_s = time.time() - age_s
    os.utime(path, (then_s, then_s))
    return path


@pytest.mark.parametrize("content", [b"", b"\x02", bytes(64), BEGUN])
@pytest.mark.parametrize("name", ["fastrtps_port7661", "fastdds_port7661"])
def test_a_port_that_was_never_finished_goes(tmp_path, name, content):
    port = make(tmp_path, name, content)
    assert remove_torn_ports(str(tmp_path)) == [name]
    assert not port.exists()


@pytest.mark.parametrize("content", [b"", b"\x02", bytes(64), BEGUN])
def test_who_waits_for_it_reads_that_it_is_corrupted(tmp_path, content):
    with make(tmp_path, "fastrtps_port7661", content).open("rb") as held:
        remove_torn_ports(str(tmp_path))
        assert held.read(4) == b"\x03\0\0\0"


@pytest.mark.parametrize(
    ("name", "content", "age_s"),
    [
        ("fastrtps_port7661", FILLED, 1000.0),
        ("fastrtps_port7661", b"", 0.0),
        ("fastrtps_port7661_el", b"", 1000.0),
        ("fastrtps_0564232d5403faab_el", b"", 1000.0),
        ("somebody_elses", b"", 1000.0),
    ],
)
def test_everything_else_stays(tmp_path, name, content, age_s):
    path = make(tmp_path, name, content, age_s)
    assert remove_torn_ports(str(tmp_path)) == []
    assert path.exists()


def test_a_missing_folder_is_not_an_error(tmp_path):
    assert remove_torn_ports(str(tmp_path / "none")) == []
