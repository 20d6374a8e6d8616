"""The files of Fast DDS in /dev/shm: what they are called, and who holds their locks.

A segment `fastrtps_X` comes with a lock file `fastrtps_X_el`, on which its owner holds a lock: the
kernel's list of locks says which process owns which segment. A port `fastrtps_portN` is a segment
to which other processes send. Such a process has the port mapped, without a lock. In Fast DDS 3 the
names begin with `fastdds_`.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress

SHM_FOLDER = "/dev/shm"
PREFIXES = ("fastrtps_", "fastdds_")
PORT_PREFIXES = tuple(f"{prefix}port" for prefix in PREFIXES)
LOCK_SUFFIXES = ("_el", "_sl")
OTHERS = 0o077
OWNER_ONLY = 0o600
LOCK_LIST = "/proc/locks"
_READS = 5
_LARGE = 1 << 16
_IN_CREATE = 0x100


def lock_names(stem: str) -> tuple[str, ...]:
    """Return the names that a segment's lock file can have: exclusive or shared."""
    return tuple(stem + suffix for suffix in LOCK_SUFFIXES)


def mutex_file(port: str) -> str:
    """Return the name of the semaphore that Fast DDS holds while it opens the port."""
    return f"sem.{port}_mutex"


def lock_files(folder: str) -> dict[str, int]:
    """Return the inodes of the folder's lock files by segment; a segment has one kind of lock."""
    found: dict[str, int] = {}
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            if entry.name.startswith(PREFIXES) and entry.name.endswith(LOCK_SUFFIXES):
                found[entry.name[:-3]] = entry.inode()
    return found


def lock_owners(folder: str) -> dict[int, set[int]]:
    """Return the processes that hold locks on files of the folder's device, by inode.

    See proc_locks(5): the sixth field is major:minor:inode, the first two in hexadecimal.
    """
    owners: dict[int, set[int]] = {}
    with suppress(OSError):
        device = os.stat(folder).st_dev
        prefix = f"{os.major(device):02x}:{os.minor(device):02x}:"
        for line in _listed_locks():
            fields = line.split()
            if len(fields) >= 6 and fields[1] == "FLOCK" and fields[5].startswith(prefix):
                inode = int(fields[5].removeprefix(prefix))
                owners.setdefault(inode, set()).add(int(fields[4]))
    return owners


def _listed_locks() -> Iterator[str]:
    """Yield the lines of the kernel's list; of a long list some come again.

    The kernel gives a page at a time, and leaves out a line where another lock goes between two
    pages: up to one list of fifteen lacked a lock that was held. So a long list is read again.
    """
    for _ in range(_READS):
        fd = os.open(LOCK_LIST, os.O_RDONLY)
        try:
            pages = list(iter(lambda fd=fd: os.read(fd, _LARGE), b""))
        finally:
            os.close(fd)
        yield from b"".join(pages).decode().splitlines()
        if len(pages) <= 1:
            return


def locked_segments(folder: str) -> set[str]:
    """Return the segments that have an owner, who may be a process of another container."""
    locked = lock_owners(folder)
    return {stem for stem, inode in lock_files(folder).items() if inode in locked}


def segments_of(is_owner: Callable[[int], bool], folder: str = SHM_FOLDER) -> set[str]:
    """Return the segments in a folder whose lock a process holds that `is_owner` accepts."""
    files = lock_files(folder)
    owners = lock_owners(folder) if files else {}
    return {stem for stem, inode in files.items() if any(map(is_owner, owners.get(inode, ())))}


def hide(stems: Iterable[str], folder: str = SHM_FOLDER) -> list[str]:
    """Make the files of those segments readable by this user only; return the names changed.

    Fast DDS makes its segments readable by every user, regardless of the umask, and a process that
    sends to a port may make the port anew long after its reader has hidden it.
    """
    hidden: list[str] = []
    for stem in stems:
        for name in (stem, *lock_names(stem), mutex_file(stem)):
            path = os.path.join(folder, name)
            with suppress(OSError):
                if os.stat(path).st_mode & OTHERS:
                    os.chmod(path, OWNER_ONLY)
                    hidden.append(name)
    return hidden


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
