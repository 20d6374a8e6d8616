"""Removes the files that Fast DDS leaves in /dev/shm when a supervised process is killed.

A participant that shuts down removes its own files; one that is killed leaves up to eight.
Each segment `fastrtps_X` comes with a lock file `fastrtps_X_el` on which its owner holds a lock, so
the kernel's list of locks says which process owns which segment. The lock is looked up when the
file appears (inotify). After the owner's death the files are removed, but only if the lock is free,
because then no process uses them. A port also stays while a living process has it mapped. A process
that has sent to a participant keeps the participant's port mapped, and the next participant takes
the same port over. If the file were replaced, messages would go to the removed file.
"""

from __future__ import annotations

import ctypes
import fcntl
import os
import re
from collections.abc import Callable
from contextlib import suppress

SHM_FOLDER = "/dev/shm"
PREFIX = "fastrtps_"
PORT_PREFIX = "fastrtps_port"
LOCK_SUFFIXES = ("_el", "_sl")
_IN_CREATE = 0x100


class SharedMemoryLedger:
    """Keeps a list of the segments that supervised processes own; belongs to the loop's thread.

    Args:
        is_ours: tells whether a process id belongs to a supervised process or a descendant.
        folder: where the segments are.
    """

    def __init__(self, is_ours: Callable[[int], bool], folder: str = SHM_FOLDER) -> None:
        self._is_ours = is_ours
        self._folder = folder
        self._owned: set[str] = set()

    def observe(self) -> None:
        """Add the segments that supervised processes own now."""
        lock_files = self._lock_files()
        owners = lock_owners(self._folder) if lock_files else {}
        for name, inode in lock_files:
            if any(self._is_ours(pid) for pid in owners.get(inode, ())):
                self._owned.add(_stem(name))

    def sweep(self) -> list[str]:
        """Remove the listed segments that have no living owner; return their names.

        A removed segment stays on the list. A process that still sends to a dead one creates the
        segment of its port again, and does not remove it at its own end.
        """
        existing = [stem for stem in sorted(self._owned) if self._files(stem)]
        in_use = mapped_ports(self._folder) if existing else set[str]()
        removed: list[str] = []
        for stem in existing:
            # The order matters: trying a port's lock would disturb a process that is creating it.
            if stem not in in_use and self._is_abandoned(stem):
                for name in self._files(stem):
                    with suppress(OSError):
                        os.unlink(os.path.join(self._folder, name))
                        removed.append(name)
        return removed

    def _files(self, stem: str) -> list[str]:
        """Return the existing files of a segment."""
        names = segment_files(stem)
        return [name for name in names if os.path.exists(os.path.join(self._folder, name))]

    def _lock_files(self) -> list[tuple[str, int]]:
        try:
            with os.scandir(self._folder) as entries:
                return [
                    (entry.name, entry.inode())
                    for entry in entries
                    if entry.name.startswith(PREFIX) and entry.name.endswith(LOCK_SUFFIXES)
                ]
        except OSError:
            return []

    def _is_abandoned(self, stem: str) -> bool:
        """Return whether no process holds a lock of the segment."""
        for suffix in LOCK_SUFFIXES:
            try:
                fd = os.open(os.path.join(self._folder, stem + suffix), os.O_RDONLY)
            except OSError:
                continue
            try:
                fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                return False
            finally:
                os.close(fd)
        return True


def hide_own_segments(folder: str = SHM_FOLDER) -> list[str]:
    """Make this process's shared memory readable by this user only; return the file names.

    Fast DDS makes its segments readable by every user, regardless of the umask.
    """
    owners = lock_owners(folder)
    hidden: list[str] = []
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            ours = os.getpid() in owners.get(entry.inode(), ())
            if ours and entry.name.startswith(PREFIX) and entry.name.endswith(LOCK_SUFFIXES):
                for name in segment_files(_stem(entry.name)):
                    with suppress(OSError):
                        os.chmod(os.path.join(folder, name), 0o600)
                        hidden.append(name)
    return hidden


def segment_files(stem: str) -> tuple[str, ...]:
    """Return the names that a segment's files can have; some of them may not exist."""
    return (stem, *(stem + suffix for suffix in LOCK_SUFFIXES), f"sem.{stem}_mutex")


def watch_folder(folder: str = SHM_FOLDER) -> int | None:
    """Return an inotify file that becomes readable when a file is created in the folder.

    Return None if inotify is not available. The ledger then finds and removes fewer segments.
    """
    libc = ctypes.CDLL(None, use_errno=True)
    fd = libc.inotify_init1(os.O_NONBLOCK | os.O_CLOEXEC)
    if fd < 0:
        return None
    if libc.inotify_add_watch(fd, os.fsencode(folder), _IN_CREATE) < 0:
        os.close(fd)
        return None
    return fd


def _stem(lock_file: str) -> str:
    for suffix in LOCK_SUFFIXES:
        lock_file = lock_file.removesuffix(suffix)
    return lock_file


def mapped_ports(folder: str, processes: str = "/proc") -> set[str]:
    """Return the names of the folder's ports that some process has mapped; see proc_pid_maps(5).

    A process of another container may have a port of the same name in a folder of its own; it does
    not count. The maps of other users' processes are not readable, but their locks still count.
    """
    wanted = re.compile(f"{re.escape(folder)}/({PORT_PREFIX}\\S+)$", re.MULTILINE)
    here = os.stat(folder)
    names: set[str] = set()
    for pid in filter(str.isdigit, os.listdir(processes)):
        with (
            suppress(OSError),
            open(f"{processes}/{pid}/maps", encoding="utf-8", errors="replace") as file,
        ):
            mapped = wanted.findall(file.read())
            if mapped and os.path.samestat(os.stat(f"{processes}/{pid}/root{folder}"), here):
                names.update(mapped)
    return names


def lock_owners(folder: str) -> dict[int, set[int]]:
    """Return the processes that hold locks on files of the folder's device, by inode.

    See proc_locks(5): the sixth field is major:minor:inode, the first two in hexadecimal.
    """
    owners: dict[int, set[int]] = {}
    with suppress(OSError), open("/proc/locks", encoding="ascii") as file:
        device = os.stat(folder).st_dev
        prefix = f"{os.major(device):02x}:{os.minor(device):02x}:"
        for line in file:
            fields = line.split()
            if len(fields) >= 6 and fields[1] == "FLOCK" and fields[5].startswith(prefix):
                inode = int(fields[5].removeprefix(prefix))
                owners.setdefault(inode, set()).add(int(fields[4]))
    return owners
