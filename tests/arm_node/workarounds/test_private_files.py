"""Which files lose the rights of other users; the shared memory here is the test's own."""

import mmap
import os
from pathlib import Path

import pytest

from arm_node.workarounds.private_files import hide_shared_memory, made_private

pytestmark = pytest.mark.workaround("private_files")


def rights(path: Path) -> int:
    return path.stat().st_mode & 0o777


@pytest.fixture
def shared():
    """Make files in shared memory that everybody may read; removes them after the test."""
    made: list[Path] = []

    def make(name: str) -> Path:
        made.append(Path(f"/dev/shm/{name}_{os.getpid()}"))
        made[-1].write_bytes(bytes(64))
        made[-1].chmod(0o644)
        return made[-1]

    yield make
    for path in made:
        path.unlink()


def test_files_made_inside_are_this_user_s_alone(tmp_path):
    before = os.umask(0o022)
    try:
        with made_private():
            (tmp_path / "inside").touch()
            (tmp_path / "folder").mkdir()
        (tmp_path / "after").touch()
    finally:
        os.umask(before)
    assert rights(tmp_path / "inside") == 0o600
    assert rights(tmp_path / "folder") == 0o700
    assert rights(tmp_path / "after") == 0o644


@pytest.mark.parametrize("name", ["fastrtps", "fastdds"])
def test_shared_memory_in_use_is_hidden_and_nothing_else(shared, name):
    mapped, semaphore = shared(f"{name}_mapped"), shared(f"sem.{name}_port_mutex")
    lock, unused, other = shared(f"{name}_x_el"), shared(f"{name}_unused"), shared("other")
    with mapped.open("r+b") as one, semaphore.open("r+b") as two, other.open("r+b") as three:
        maps = [mmap.mmap(file.fileno(), 0) for file in (one, two, three)]
    with lock.open():
        assert set(hide_shared_memory()) >= {str(mapped), str(semaphore), str(lock)}
        assert {str(mapped), str(semaphore), str(lock)}.isdisjoint(hide_shared_memory())
    assert [rights(path) for path in (mapped, semaphore, lock)] == [0o600] * 3
    assert [rights(path) for path in (unused, other)] == [0o644] * 2
    for one in maps:
        one.close()


def test_files_of_other_users_are_left_alone(shared, monkeypatch):
    path = shared("fastrtps_x")
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    with path.open():
        hide_shared_memory()
    assert rights(path) == 0o644


def test_a_process_that_cannot_be_looked_into_has_nothing(tmp_path):
    assert hide_shared_memory(str(tmp_path)) == []
