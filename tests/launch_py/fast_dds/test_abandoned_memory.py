"""Shared-memory files that no process uses, in a folder of the test's own."""

import fcntl
import os
import subprocess
import sys

import pytest

from launch_py.fast_dds.removal import remove_abandoned

SEGMENT = ("fastrtps_0d1a538084f21f6e", "fastrtps_0d1a538084f21f6e_el")
PORT = (
    "fastrtps_port7411",
    "fastrtps_port7411_el",
    "fastrtps_port7411_sl",
    "sem.fastrtps_port7411_mutex",
)
# The module mmap would also keep the file open.
MAP = """
import ctypes, sys
libc = ctypes.CDLL(None)
libc.mmap.restype = ctypes.c_void_p
libc.mmap.argtypes = (ctypes.c_void_p, ctypes.c_size_t, *[ctypes.c_int] * 3, ctypes.c_long)
with open(sys.argv[1], "r+b") as file:
    assert libc.mmap(None, 64, 1, 1, file.fileno(), 0) not in (None, ctypes.c_void_p(-1).value)
print("up", flush=True)
sys.stdin.read()
"""


@pytest.fixture
def folder(shm_folder):
    """A folder with the files of a dead process, and files that do not belong to Fast DDS."""
    for name in (*SEGMENT, *PORT, "fastrtps_notes.txt", "sem.other", "lttng-ust-wait-6"):
        (shm_folder / name).write_bytes(b"\0" * 64)
    return shm_folder


def sweep(folder):
    return set(remove_abandoned(str(folder)))


def test_only_the_files_of_a_dead_process_are_removed(folder):
    assert sweep(folder) == {*SEGMENT, *PORT}
    assert {path.name for path in folder.iterdir()} == {
        "fastrtps_notes.txt",
        "sem.other",
        "lttng-ust-wait-6",
    }
    assert sweep(folder) == set()


def test_the_files_of_fast_dds_3_are_removed_too(shm_folder):
    names = {name.replace("fastrtps", "fastdds") for name in (*SEGMENT, *PORT)}
    for name in names:
        (shm_folder / name).write_bytes(b"\0" * 64)
    assert sweep(shm_folder) == names


def test_a_mutex_stays_while_any_participant_lives(folder):
    """Another process may wait to open it."""
    with (folder / "fastrtps_1_el").open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        assert sweep(folder) == {*SEGMENT, *PORT[:3]}
        assert sweep(folder) == set()
    assert sweep(folder) == {"fastrtps_1_el", PORT[3]}


@pytest.mark.parametrize("lock", [SEGMENT[1], PORT[1], PORT[2]])
@pytest.mark.parametrize("kind", [fcntl.LOCK_EX, fcntl.LOCK_SH])
def test_a_locked_file_stays(folder, lock, kind):
    with (folder / lock).open() as file:
        fcntl.flock(file, kind)
        kept = (*SEGMENT, PORT[3]) if lock in SEGMENT else PORT
        assert sweep(folder) == {*SEGMENT, *PORT} - set(kept)
    assert sweep(folder) == set(kept)


@pytest.mark.parametrize("name", [SEGMENT[1], *PORT])
def test_an_open_file_stays(folder, name):
    with (folder / name).open():
        kept = SEGMENT if name in SEGMENT else PORT
        assert sweep(folder) == {*SEGMENT, *PORT} - set(kept)
    assert sweep(folder) == set(kept)


def test_a_port_that_another_process_has_mapped_stays(folder):
    with subprocess.Popen(
        [sys.executable, "-S", "-c", MAP, str(folder / PORT[0])],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"up\n"
        assert sweep(folder) == set(SEGMENT)
    assert sweep(folder) == set(PORT)


def test_files_of_other_users_stay(folder, monkeypatch):
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    assert sweep(folder) == set()


def test_a_missing_folder_is_ignored(tmp_path):
    assert sweep(tmp_path / "none") == set()
