"""Only the shared-memory files of our own dead processes are removed.

The folder is a stand-in; the locks are real, held by real processes.
"""

import mmap
import subprocess
import sys

import pytest

from launch_py.fast_dds.removal import SharedMemoryLedger

HOLD = (
    "import fcntl, sys; f = open(sys.argv[1]); fcntl.flock(f, fcntl.LOCK_EX); "
    "print('held', flush=True); sys.stdin.read()"
)


@pytest.fixture
def segment(shm_folder):
    """Create the files of a segment and a process that owns it."""
    owners = []

    def make(stem):
        for name in (stem, f"{stem}_el"):
            (shm_folder / name).touch()
        owner = subprocess.Popen(
            [sys.executable, "-c", HOLD, str(shm_folder / f"{stem}_el")],
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


def test_the_files_of_our_dead_process_are_removed(shm_folder, segment):
    owner = segment("fastrtps_1")
    ledger = SharedMemoryLedger(lambda pid: pid == owner.pid, str(shm_folder))
    ledger.observe()
    end(owner)
    assert sorted(ledger.sweep()) == ["fastrtps_1", "fastrtps_1_el"]
    assert list(shm_folder.iterdir()) == []


def test_the_files_of_a_living_process_stay(shm_folder, segment):
    segment("fastrtps_1")
    ledger = SharedMemoryLedger(lambda _: True, str(shm_folder))
    ledger.observe()
    assert ledger.sweep() == []


def test_the_files_of_other_dead_processes_stay(shm_folder, segment):
    ours, other = segment("fastrtps_1"), segment("fastrtps_2")
    ledger = SharedMemoryLedger(lambda pid: pid == ours.pid, str(shm_folder))
    ledger.observe()
    end(ours)
    end(other)
    ledger.sweep()
    assert {p.name for p in shm_folder.iterdir()} == {"fastrtps_2", "fastrtps_2_el"}


def test_a_port_that_a_sender_makes_anew_is_hidden_from_other_users(shm_folder, segment):
    owner = segment("fastrtps_port7411")
    ledger = SharedMemoryLedger(lambda pid: pid == owner.pid, str(shm_folder))
    ledger.observe()
    port = shm_folder / "fastrtps_port7411"
    port.unlink()
    port.touch()
    port.chmod(0o644)
    ledger.observe()
    assert port.stat().st_mode & 0o777 == 0o600


def test_files_that_a_surviving_process_recreates_are_removed_again(shm_folder, segment):
    owner = segment("fastrtps_port7411")
    ledger = SharedMemoryLedger(lambda _: True, str(shm_folder))
    ledger.observe()
    end(owner)
    ledger.sweep()
    (shm_folder / "fastrtps_port7411").touch()
    assert "fastrtps_port7411" in ledger.sweep()
    assert list(shm_folder.iterdir()) == []


def test_a_port_that_another_process_has_taken_over_stays(shm_folder, segment):
    owner = segment("fastrtps_port7411")
    ledger = SharedMemoryLedger(lambda pid: pid == owner.pid, str(shm_folder))
    ledger.observe()
    end(owner)
    segment("fastrtps_port7411")
    assert ledger.sweep() == []


def test_a_port_that_another_process_still_sends_to_stays(shm_folder, segment):
    owner = segment("fastrtps_port7411")
    ledger = SharedMemoryLedger(lambda pid: pid == owner.pid, str(shm_folder))
    ledger.observe()
    end(owner)
    (shm_folder / "fastrtps_port7411").write_bytes(bytes(4096))
    with (shm_folder / "fastrtps_port7411").open("r+b") as file, mmap.mmap(file.fileno(), 0):
        assert ledger.sweep() == []
    assert "fastrtps_port7411" in ledger.sweep()


def test_a_dead_process_s_segment_is_removed_although_it_is_still_read(shm_folder, segment):
    owner = segment("fastrtps_1")
    ledger = SharedMemoryLedger(lambda pid: pid == owner.pid, str(shm_folder))
    ledger.observe()
    (shm_folder / "fastrtps_1").write_bytes(bytes(4096))
    with (shm_folder / "fastrtps_1").open("r+b") as file, mmap.mmap(file.fileno(), 0):
        end(owner)
        assert "fastrtps_1" in ledger.sweep()


def test_a_folder_that_does_not_exist_is_empty():
    ledger = SharedMemoryLedger(lambda _: True, "/nowhere")
    ledger.observe()
    assert ledger.sweep() == []
