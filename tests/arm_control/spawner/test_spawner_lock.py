"""The machine's spawner lock; flock counts per open file, so one process can play two."""

import fcntl
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from arm_control.errors import SpawnError, WaitInterruptedError
from arm_control.spawner.spawner_lock import (
    ATTEMPT_S,
    ATTEMPTS,
    RETRY_DELAY_S,
    SILENT_S,
    spawner_lock,
    spawner_lock_path,
)
from arm_control.testing import ManualClock


class Waiting:
    """Waits like the process: time passes until it is told to end."""

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.interrupt_at_s = float("inf")

    def __call__(self, seconds: float) -> bool:
        self.clock.advance(seconds)
        return self.clock.now_s() >= self.interrupt_at_s


@pytest.fixture
def path(tmp_path) -> Path:
    return tmp_path / "locks" / "spawner.lock"


@pytest.fixture
def other(path) -> Iterator[int]:
    """Hold the lock as another spawner; closing the descriptor releases it."""
    path.parent.mkdir(parents=True)
    file = os.open(path, os.O_RDWR | os.O_CREAT)
    fcntl.flock(file, fcntl.LOCK_EX)
    yield file
    os.close(file)


def is_locked(path: Path) -> bool:
    with path.open() as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        return False


@pytest.mark.parametrize(
    ("environ", "folder"),
    [({"ROS_HOME": "/x"}, Path("/x")), ({"ROS_HOME": ""}, Path.home() / ".ros"), ({}, None)],
)
def test_its_path_is_the_same_as_ros2_controls(environ, folder):
    folder = folder or Path.home() / ".ros"
    expected = folder / "locks" / "ros2-control-controller-spawner.lock"
    assert spawner_lock_path(environ) == expected


def test_it_is_held_inside_and_free_after(path):
    waiting = Waiting()
    with spawner_lock(path, waiting, waiting.clock):
        assert is_locked(path)
    assert not is_locked(path)
    with spawner_lock(path, waiting, waiting.clock):
        assert is_locked(path)


@pytest.mark.parametrize("released_s", [0.5, 2.0])
def test_it_waits_for_another_and_logs_a_long_wait(path, other, released_s, caplog):
    caplog.set_level("INFO")
    waiting = Waiting()

    def wait(seconds: float) -> bool:
        if waiting.clock.now_s() > released_s:
            fcntl.flock(other, fcntl.LOCK_UN)
        return waiting(seconds)

    with spawner_lock(path, wait, waiting.clock):
        assert released_s < waiting.clock.now_s() < released_s + 0.5
    said = [f"waiting for another spawner, which holds {path}"]
    assert caplog.messages == (said if released_s > SILENT_S else [])


def test_it_gives_up_after_its_attempts(path, other, caplog):
    waiting = Waiting()
    with (
        pytest.raises(SpawnError, match="another spawner holds"),
        spawner_lock(path, waiting, waiting.clock),
    ):
        pytest.fail("the lock was not taken")
    total_s = ATTEMPTS * (ATTEMPT_S + RETRY_DELAY_S)
    assert waiting.clock.now_s() == pytest.approx(total_s, abs=1.0)
    assert len(caplog.records) == ATTEMPTS


def test_the_end_of_the_process_ends_the_wait(path, other):
    waiting = Waiting()
    waiting.interrupt_at_s = 1.0
    with pytest.raises(WaitInterruptedError), spawner_lock(path, waiting, waiting.clock):
        pytest.fail("the lock was not taken")
    assert waiting.clock.now_s() < 2.0


def test_a_folder_that_cannot_be_written_does_no_harm(tmp_path, caplog):
    (tmp_path / "file").touch()
    reached = False
    with spawner_lock(tmp_path / "file" / "x.lock", Waiting(), ManualClock()):
        reached = True
    assert reached
    assert "continuing without the spawner lock" in caplog.text
