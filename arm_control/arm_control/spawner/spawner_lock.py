"""The lock that lets only one spawner of a machine work at a time."""

import fcntl
import logging
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from arm_control.errors import SpawnError, WaitInterruptedError
from arm_control.loop.clock import Clock, MonotonicClock

logger = logging.getLogger(__name__)

ATTEMPTS = 5
ATTEMPT_S = 20.0
RETRY_DELAY_S = 3.0
SILENT_S = 1.0
"""Spawners that start together wait no longer than this for each other, which is not logged."""
_POLL_S = 0.05


def spawner_lock_path(environ: Mapping[str, str] = os.environ) -> Path:
    """Return the lock file, which ros2_control's own spawners use as well."""
    home = environ.get("ROS_HOME") or Path("~/.ros").expanduser()
    return Path(home, "locks", "ros2-control-controller-spawner.lock")


@contextmanager
def spawner_lock(
    path: Path, wait: Callable[[float], bool], clock: Clock | None = None
) -> Iterator[None]:
    """Hold the machine's spawner lock.

    Like ros2_control's spawner it uses flock(2) on the open file, so each waits for the other. If
    the file cannot be created, it logs a warning and goes on without the lock, which only keeps the
    output in order. The file is created with its folder if it is missing. `wait` returns True early
    if the process must end.

    Raises:
        SpawnError: another process has held it during all attempts.
        WaitInterruptedError: the process must end.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
    except OSError as error:
        logger.warning("continuing without the spawner lock: %s", error)
        yield
        return
    try:
        _lock(file, path, wait, clock or MonotonicClock())
        yield
    finally:
        os.close(file)


def _lock(file: int, path: Path, wait: Callable[[float], bool], clock: Clock) -> None:
    started_s = clock.now_s()
    logged = False
    for attempt in range(1, ATTEMPTS + 1):
        deadline_s = clock.now_s() + ATTEMPT_S
        while clock.now_s() < deadline_s:
            if _try_lock(file):
                return
            if not logged and clock.now_s() - started_s >= SILENT_S:
                logger.info("waiting for another spawner, which holds %s", path)
                logged = True
            _pause(wait, _POLL_S)
        logger.warning(
            "another spawner has held %s for %g s (attempt %d of %d)",
            path,
            ATTEMPT_S,
            attempt,
            ATTEMPTS,
        )
        _pause(wait, RETRY_DELAY_S)
    raise SpawnError(
        f"another spawner holds {path} and does not end; `fuser {path}` shows its process id"
    )


def _try_lock(file: int) -> bool:
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _pause(wait: Callable[[float], bool], seconds: float) -> None:
    if wait(seconds):
        raise WaitInterruptedError("interrupted while waiting for the spawner lock")
