"""Removes what dead processes of this user left in Fast DDS's shared memory.

A launch whose supervisor was killed cannot remove its own files, because its list of them is lost
(see `shared_memory`). The owner of a file is then not known. But a file that a process uses is
locked, open or mapped. The kernel reports all three by inode, which is the same in every mount
namespace.
"""

from __future__ import annotations

import fcntl
import os
import re
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, suppress

from launch_py.fast_dds.shared_memory import (
    LOCK_SUFFIXES,
    PORT_PREFIX,
    SHM_FOLDER,
    lock_owners,
)

_FILE = re.compile(r"(?:sem\.)?(fastrtps_(?:port\d+|[0-9a-f]+))(?:_[es]l|_mutex)?")
_FILE_MARK = "fastrtps_"
TRIES = 3
"""An owner may give its lock up between the attempt to take it and the look at who has it."""


class _LockedError(Exception):
    """A file is locked by a process that has only just taken it."""


class _UnseenOwnerError(_LockedError):
    """A file is locked by a process that is not visible from here."""


def remove_abandoned(folder: str = SHM_FOLDER, processes: str = "/proc") -> list[str]:
    """Remove the files of this user that no process uses; return their names.

    A lock whose owner is not visible shows that a container shares the folder. Ports then stay,
    because a process that sends to a port has it mapped without a lock.

    Args:
        folder: the folder of the shared-memory files.
        processes: the mount point of proc(5).
    """
    segments = _own_segments(folder)
    locked = lock_owners(folder)
    unlocked = {
        stem: inodes
        for stem, inodes in segments.items()
        if locked.keys().isdisjoint(inodes.values())
    }
    if not unlocked:
        return []
    in_use = _inodes_in_use(os.stat(folder).st_dev, processes)
    abandoned = {s: i for s, i in unlocked.items() if in_use.isdisjoint(i.values())}
    removed: list[str] = []
    keep_ports = False
    # Ports come last: by then it is known whether another container uses the folder.
    for stem in sorted(abandoned, key=lambda stem: stem.startswith(PORT_PREFIX)):
        if keep_ports and stem.startswith(PORT_PREFIX):
            break
        try:
            removed += _remove(folder, list(abandoned[stem]))
        except _UnseenOwnerError:
            keep_ports = True
        except _LockedError:
            continue
    return removed


def _own_segments(folder: str) -> dict[str, dict[str, int]]:
    """Return the inodes of this user's files by segment and file name."""
    segments: dict[str, dict[str, int]] = {}
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            match = _FILE.fullmatch(entry.name)
            with suppress(OSError):
                if match and entry.stat(follow_symlinks=False).st_uid == os.geteuid():
                    segments.setdefault(match[1], {})[entry.name] = entry.inode()
    return segments


def _inodes_in_use(device: int, processes: str) -> set[int]:
    """Return the inodes of the device that a process has open or mapped.

    The open files of a process are read before the mapped ones, because a file is opened before it
    is mapped and closed only afterwards. Processes of other users are not readable.
    """
    found: set[int] = set()
    for pid in filter(str.isdigit, os.listdir(processes)):
        found.update(_open_inodes(f"{processes}/{pid}/fd", device))
        found.update(_mapped_inodes(f"{processes}/{pid}/maps", device))
    return found


def _open_inodes(folder: str, device: int) -> Iterator[int]:
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            with suppress(OSError):
                if _FILE_MARK in os.readlink(entry.path):
                    status = os.stat(entry.path)
                    if status.st_dev == device:
                        yield status.st_ino


def _mapped_inodes(path: str, device: int) -> Iterator[int]:
    """Yield the mapped inodes; the fourth field of a line is the device, the fifth the inode."""
    wanted = f"{os.major(device):02x}:{os.minor(device):02x}"
    with suppress(OSError), open(path, encoding="utf-8", errors="replace") as file:
        for line in file:
            if _FILE_MARK in line:
                fields = line.split(maxsplit=5)
                if fields[3] == wanted:
                    yield int(fields[4])


def _remove(folder: str, names: Sequence[str]) -> list[str]:
    """Remove a segment's files while holding its locks, so that no process starts to use them."""
    removed: list[str] = []
    with ExitStack() as held:
        for name in names:
            if name.endswith(LOCK_SUFFIXES):
                _hold(os.path.join(folder, name), held)
        for name in names:
            with suppress(OSError):
                os.unlink(os.path.join(folder, name))
                removed.append(name)
    return removed


def _hold(path: str, held: ExitStack) -> None:
    try:
        fd = os.open(path, os.O_RDONLY)
    except OSError:
        return
    held.callback(os.close, fd)
    for _ in range(TRIES):
        with suppress(OSError):
            fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return
        # Another process that cleans up holds locks for a moment, too.
        if os.fstat(fd).st_ino in lock_owners(os.path.dirname(path)):
            raise _LockedError
    raise _UnseenOwnerError
