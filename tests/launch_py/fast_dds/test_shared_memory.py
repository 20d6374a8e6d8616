"""Only the shared-memory files of our own dead processes are removed.

The folder is a stand-in; the locks are real, held by real processes.
"""

import fcntl
import mmap
import os
import select
import subprocess
import sys

import pytest

from launch_py.fast_dds.shared_memory import (
    SharedMemoryLedger,
    hide_own_segments,
    mapped_ports,
    watch_folder,
)

HOLD = (
    "import fcntl, sys; f = open(sys.argv[1]); fcntl.flock(f, fcntl.LOCK_EX); "
    "print('held', flush=True); sys.stdin.read()"
)


@pytest.fixture
def segment(tmp_path):
    """Create the files of a segment and a process that owns it."""
    owners = []

    def make(stem):
        for name in (stem, f"{stem}_el", f"sem.{stem}_mutex"):
            (tmp_path / name).touch()
        owner = subprocess.Popen(
            [sys.executable, "-c", HOLD, str(tmp_path / f"{stem}_el")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        owners.append(owner)
        assert owner.stdout is not None
        assert owner.stdout.readline() == "held\n"
        return owner

    yield make
    for owner in owners:
        owner.kill()
        owner.communicate()


def end(owner):
    owner.kill()
    owner.wait()


def test_the_files_of_our_dead_process_are_removed(tmp_path, segment):
    owner = segment("fastrtps_1")
    ledger = SharedMemoryLedger(lambda pid: pid == owner.pid, str(tmp_path))
    ledger.observe()
    end(owner)
    assert sorted(ledger.sweep()) == ["fastrtps_1", "fastrtps_1_el", "sem.fastrtps_1_mutex"]
    assert list(tmp_path.iterdir()) == []


def test_the_files_of_a_living_process_stay(tmp_path, segment):
    segment("fastrtps_1")
    ledger = SharedMemoryLedger(lambda _: True, str(tmp_path))
    ledger.observe()
    assert ledger.sweep() == []


def test_the_files_of_other_dead_processes_stay(tmp_path, segment):
    ours, other = segment("fastrtps_1"), segment("fastrtps_2")
    ledger = SharedMemoryLedger(lambda pid: pid == ours.pid, str(tmp_path))
    ledger.observe()
    end(ours)
    end(other)
    ledger.sweep()
    assert {p.name for p in tmp_path.iterdir()} == {
        "fastrtps_2",
        "fastrtps_2_el",
        "sem.fastrtps_2_mutex",
    }


def test_files_that_a_surviving_process_recreates_are_removed_again(tmp_path, segment):
    owner = segment("fastrtps_port7411")
    ledger = SharedMemoryLedger(lambda _: True, str(tmp_path))
    ledger.observe()
    end(owner)
    ledger.sweep()
    (tmp_path / "fastrtps_port7411").touch()
    assert ledger.sweep() == ["fastrtps_port7411"]


def test_a_port_that_another_process_has_taken_over_stays(tmp_path, segment):
    owner = segment("fastrtps_port7411")
    ledger = SharedMemoryLedger(lambda pid: pid == owner.pid, str(tmp_path))
    ledger.observe()
    end(owner)
    segment("fastrtps_port7411")
    assert ledger.sweep() == []


def test_a_port_that_another_process_still_sends_to_stays(tmp_path, segment):
    owner = segment("fastrtps_port7411")
    ledger = SharedMemoryLedger(lambda pid: pid == owner.pid, str(tmp_path))
    ledger.observe()
    end(owner)
    (tmp_path / "fastrtps_port7411").write_bytes(bytes(4096))
    with (tmp_path / "fastrtps_port7411").open("r+b") as file, mmap.mmap(file.fileno(), 0):
        assert ledger.sweep() == []
    assert "fastrtps_port7411" in ledger.sweep()


def test_a_port_with_the_same_name_in_another_container_does_not_count(tmp_path):
    folder, processes = tmp_path / "shm", tmp_path / "proc"
    folder.mkdir()
    for pid, root, port in (
        ("1", "/", "fastrtps_port7000"),
        ("2", tmp_path / "container", "fastrtps_port7411"),
    ):
        (processes / pid).mkdir(parents=True)
        (processes / pid / "root").symlink_to(root)
        (processes / pid / "maps").write_text(f"7f00-7f01 rw-s 0 00:2a 1   {folder}/{port}\n")
    (tmp_path / f"container{folder}").mkdir(parents=True)
    assert mapped_ports(str(folder), str(processes)) == {"fastrtps_port7000"}


def test_a_dead_process_s_segment_is_removed_although_it_is_still_read(tmp_path, segment):
    owner = segment("fastrtps_1")
    ledger = SharedMemoryLedger(lambda pid: pid == owner.pid, str(tmp_path))
    ledger.observe()
    (tmp_path / "fastrtps_1").write_bytes(bytes(4096))
    with (tmp_path / "fastrtps_1").open("r+b") as file, mmap.mmap(file.fileno(), 0):
        end(owner)
        assert "fastrtps_1" in ledger.sweep()


def test_a_folder_that_does_not_exist_is_empty():
    ledger = SharedMemoryLedger(lambda _: True, "/nowhere")
    ledger.observe()
    assert ledger.sweep() == []
    assert watch_folder("/nowhere") is None


def test_a_new_file_wakes_the_watcher(tmp_path):
    fd = watch_folder(str(tmp_path))
    assert fd is not None
    assert select.select([fd], [], [], 0)[0] == []
    (tmp_path / "fastrtps_1").touch()
    assert select.select([fd], [], [], 10)[0] == [fd]
    os.close(fd)


def test_only_the_segments_of_this_process_are_hidden(tmp_path):
    for name in ("fastrtps_1", "fastrtps_1_el", "fastrtps_2", "fastrtps_2_el"):
        (tmp_path / name).touch(0o644)
        (tmp_path / name).chmod(0o644)
    with (tmp_path / "fastrtps_1_el").open() as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        hidden = hide_own_segments(str(tmp_path))
    assert sorted(hidden) == ["fastrtps_1", "fastrtps_1_el"]
    modes = {path.name: path.stat().st_mode & 0o777 for path in tmp_path.iterdir()}
    assert modes["fastrtps_1"] == modes["fastrtps_1_el"] == 0o600
    assert modes["fastrtps_2"] == modes["fastrtps_2_el"] == 0o644
