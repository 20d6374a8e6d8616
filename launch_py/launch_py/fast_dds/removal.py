"""Removes the files that Fast DDS leaves in /dev/shm, and disturbs none that is opening them.

A participant that shuts down removes its own files; one that is killed leaves up to eight. The
supervisor keeps a list of those of its processes (`SharedMemoryLedger`). If it is itself killed,
the list is lost and the owner of a file not known, but the kernel knows whether the file is used
(`remove_abandoned`).

The name of a segment is used once. The number of a port is used again by the next participant, in
any domain, and Fast DDS opens a port in steps: it takes the port's mutex, maps the segment, locks
the lock file, and releases the mutex. Removed between two of the steps, the port would be a file
without a name: its reader discovers every topic and hears nothing.

So this module takes a write lease on each file; see fcntl(2). The kernel grants one only if no
process has the file open or mapped, in any container. A process that opens the file later waits
until the lease is released. The mutex of a port is leased first, because Fast DDS opens it first.
"""

from __future__ import annotations

import ctypes
import fcntl
import os
import re
import signal
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress

from launch_py.fast_dds.shared_memory import (
    PORT_PREFIXES,
    SHM_FOLDER,
    hide,
    lock_names,
    locked_segments,
    mutex_file,
    segments_of,
)

_SEMAPHORE_BYTES = 32
"""The size of glibc's sem_t on 64-bit machines, and of the file of a named semaphore."""
_LONGEST_TURN_S = 1.0
_POLL_S = 0.005


def remove_unused(stems: Iterable[str], folder: str) -> list[str]:
    """Remove the files of those segments and ports that have no living owner; return their names.

    A port stays while any process has it mapped: one that has sent to the dead participant sends to
    the next participant of the same number there. A port's mutex stays while any participant lives:
    a process that waits to open it would open the removed mutex, and the next process would make
    another.
    """
    with _turn(folder):
        return [
            name
            for stem in stems
            for name in (
                _remove_port(stem, folder)
                if stem.startswith(PORT_PREFIXES)
                else _remove_segment(stem, folder)
            )
        ]


def _remove_segment(stem: str, folder: str) -> list[str]:
    with ExitStack() as leases:
        # The owner holds the lock file as long as it lives. Others may still read the segment.
        locks = _take_leases(lock_names(stem), folder, leases)
        if locks is None or (not locks and _take_leases([stem], folder, leases) is None):
            return []
        return _unlink((stem, *lock_names(stem)), folder)


def _remove_port(stem: str, folder: str) -> list[str]:
    files, mutex = (stem, *lock_names(stem)), mutex_file(stem)
    _make_mutex(os.path.join(folder, mutex))
    with ExitStack() as leases:
        leased = _take_leases((mutex, *files), folder, leases)
        if leased is None or mutex not in leased:
            return []
        removed = _unlink(files, folder)
        # A process that was killed while it held the mutex has never released it.
        os.pwrite(leased[mutex], _free_semaphore(), 0)
        return removed if locked_segments(folder) else removed + _unlink([mutex], folder)


@contextmanager
def _turn(folder: str) -> Iterator[None]:
    """Wait until no other process cleans up the folder: two of them would deny each other leases.

    After a second it goes on, because the other process may have been stopped.
    """
    with ExitStack() as opened:
        with suppress(OSError):
            fd = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
            opened.callback(os.close, fd)
            deadline_s = time.monotonic() + _LONGEST_TURN_S
            while not _lock(fd) and time.monotonic() < deadline_s:
                time.sleep(_POLL_S)
        yield


def _lock(fd: int) -> bool:
    with suppress(BlockingIOError):
        fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return True
    return False


def _take_leases(names: Iterable[str], folder: str, leases: ExitStack) -> dict[str, int] | None:
    """Take a write lease on each of the files that exist.

    Return their descriptors, which `leases` closes, or None if not all leases are granted.
    """
    leased: dict[str, int] = {}
    for name in names:
        try:
            fd = os.open(os.path.join(folder, name), os.O_RDWR | os.O_NONBLOCK)
        except FileNotFoundError:
            continue
        except OSError:
            return None
        leases.callback(os.close, fd)
        try:
            # A process that opens the file meanwhile raises this signal, which is ignored.
            fcntl.fcntl(fd, fcntl.F_SETSIG, signal.SIGURG)
            fcntl.fcntl(fd, fcntl.F_SETLEASE, fcntl.F_WRLCK)
        except OSError:
            return None
        leased[name] = fd
    return leased


def _free_semaphore() -> bytes:
    content = ctypes.create_string_buffer(_SEMAPHORE_BYTES)
    ctypes.CDLL(None).sem_init(content, 1, 1)
    return content.raw


def _make_mutex(path: str) -> None:
    """Make a port's mutex unless it exists, complete from the beginning, as sem_open(3) does."""
    if not os.path.exists(path):
        with suppress(OSError), tempfile.NamedTemporaryFile(dir=os.path.dirname(path)) as file:
            file.write(_free_semaphore())
            file.flush()
            os.link(file.name, path)


def _unlink(names: Iterable[str], folder: str) -> list[str]:
    removed: list[str] = []
    for name in names:
        with suppress(OSError):
            os.unlink(os.path.join(folder, name))
            removed.append(name)
    return removed


class SharedMemoryLedger:
    """Keeps a list of the segments that supervised processes own; belongs to the loop's thread.

    The owner of a segment is looked up when its lock file appears (inotify). After the owner's
    death the files are removed, unless another process uses them. Until then other users cannot
    read them: a process hides what it makes, but not a port of its own that a sender made anew.
    """

    def __init__(self, is_ours: Callable[[int], bool], folder: str = SHM_FOLDER) -> None:
        self._is_ours = is_ours
        self._folder = folder
        self._owned: set[str] = set()

    def observe(self) -> None:
        """Add the segments that supervised processes own now, and hide them from other users."""
        owned = segments_of(self._is_ours, self._folder)
        self._owned |= owned
        hide(owned, self._folder)

    def sweep(self) -> list[str]:
        """Remove the listed segments that have no living owner; return their names.

        A removed segment stays on the list. A process that still sends to a dead one creates the
        segment of its port again, and does not remove it at its own end.
        """
        existing = [stem for stem in sorted(self._owned) if self._exists(stem)]
        return remove_unused(existing, self._folder) if existing else []

    def _exists(self, stem: str) -> bool:
        names = (stem, *lock_names(stem))
        return any(os.path.exists(os.path.join(self._folder, name)) for name in names)


_FILE = re.compile(r"(?:sem\.)?(fast(?:rtps|dds)_(?:port\d+|[0-9a-f]+))(?:_[es]l|_mutex)?")


def remove_abandoned(folder: str = SHM_FOLDER) -> list[str]:
    """Remove the files of this user that no process uses; return their names."""
    locked = locked_segments(folder)
    abandoned = [
        stem
        for stem, names in _own_segments(folder).items()
        # Mutexes alone stay while a participant lives; see `remove_unused`.
        if stem not in locked and not (locked and names == {mutex_file(stem)})
    ]
    return remove_unused(abandoned, folder) if abandoned else []


def _own_segments(folder: str) -> dict[str, set[str]]:
    """Return the names of this user's files by segment."""
    segments: dict[str, set[str]] = {}
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            match = _FILE.fullmatch(entry.name)
            with suppress(OSError):
                if match and entry.stat(follow_symlinks=False).st_uid == os.geteuid():
                    segments.setdefault(match[1], set()).add(entry.name)
    return segments
