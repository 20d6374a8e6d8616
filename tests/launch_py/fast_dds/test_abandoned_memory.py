"""Shared-memory files that no process uses; the folder is the test's own."""

import ctypes
import fcntl
import mmap
import os
import subprocess
import sys

import pytest

from launch_py.fast_dds.abandoned_memory import remove_abandoned

SEGMENT = ("fastrtps_0d1a538084f21f6e", "fastrtps_0d1a538084f21f6e_el")
PORT = (
    "fastrtps_port7411",
    "fastrtps_port7411_el",
    "fastrtps_port7411_sl",
    "sem.fastrtps_port7411_mutex",
)


@pytest.fixture
def folder(tmp_path):
    """A folder with the files of a dead process, and files that do not belong to Fast DDS."""
    for name in (*SEGMENT, *PORT, "fastrtps_notes.txt", "sem.other", "lttng-ust-wait-6"):
        (tmp_path / name).write_bytes(b"\0" * 64)
    return tmp_path


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


@pytest.mark.parametrize("lock", [SEGMENT[1], PORT[1], PORT[2]])
@pytest.mark.parametrize("kind", [fcntl.LOCK_EX, fcntl.LOCK_SH])
def test_a_locked_file_stays(folder, lock, kind):
    with (folder / lock).open() as file:
        fcntl.flock(file, kind)
        kept = SEGMENT if lock in SEGMENT else PORT
        assert sweep(folder) == {*SEGMENT, *PORT} - set(kept)
    assert sweep(folder) == set(kept)


@pytest.mark.parametrize("name", [*SEGMENT, *PORT])
def test_an_open_file_stays(folder, name):
    with (folder / name).open():
        kept = SEGMENT if name in SEGMENT else PORT
        assert sweep(folder) == {*SEGMENT, *PORT} - set(kept)
    assert sweep(folder) == set(kept)


@pytest.mark.parametrize("name", [SEGMENT[0], PORT[0], PORT[3]])
def test_a_mapped_file_stays(folder, name):
    # The module mmap would also keep the file open.
    libc = ctypes.CDLL(None, use_errno=True)
    libc.mmap.restype = ctypes.c_void_p
    libc.mmap.argtypes = (ctypes.c_void_p, ctypes.c_size_t, *[ctypes.c_int] * 3, ctypes.c_long)
    libc.munmap.argtypes = (ctypes.c_void_p, ctypes.c_size_t)
    with (folder / name).open("r+b") as file:
        address = libc.mmap(None, 64, mmap.PROT_READ, mmap.MAP_SHARED, file.fileno(), 0)
    assert address not in (None, ctypes.c_void_p(-1).value)
    kept = SEGMENT if name in SEGMENT else PORT
    assert sweep(folder) == {*SEGMENT, *PORT} - set(kept)
    assert libc.munmap(address, 64) == 0
    assert sweep(folder) == set(kept)


def test_another_process_s_use_counts_too(folder):
    code = "import sys; file = open(sys.argv[1]); print('up', flush=True); sys.stdin.read()"
    with subprocess.Popen(
        [sys.executable, "-S", "-c", code, str(folder / PORT[0])],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"up\n"
        assert sweep(folder) == set(SEGMENT)
    assert sweep(folder) == set(PORT)


def test_ports_stay_if_an_owner_is_not_visible(folder, tmp_path_factory, monkeypatch):
    """As in a folder shared with another container, the lock is visible and its process is not."""
    from launch_py.fast_dds import abandoned_memory

    monkeypatch.setattr(abandoned_memory, "lock_owners", lambda folder: {})
    no_processes = tmp_path_factory.mktemp("proc")
    with (folder / SEGMENT[1]).open() as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        assert remove_abandoned(str(folder), str(no_processes)) == []
    assert set(remove_abandoned(str(folder), str(no_processes))) == {*SEGMENT, *PORT}


def test_a_lock_that_is_taken_meanwhile_keeps_its_segment_only(
    folder, tmp_path_factory, monkeypatch
):
    """As by another process that cleans up at the same time."""
    from launch_py.fast_dds import abandoned_memory

    before = iter([dict[int, set[int]]()])
    now = abandoned_memory.lock_owners
    monkeypatch.setattr(abandoned_memory, "lock_owners", lambda path: next(before, now(path)))
    with (folder / SEGMENT[1]).open() as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        no_processes = str(tmp_path_factory.mktemp("proc"))
        assert set(remove_abandoned(str(folder), no_processes)) == set(PORT)


def test_files_of_other_users_stay(folder, monkeypatch):
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    assert sweep(folder) == set()


def test_a_missing_folder_is_ignored(tmp_path):
    assert sweep(tmp_path / "none") == set()
