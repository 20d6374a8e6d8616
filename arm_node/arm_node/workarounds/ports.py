"""Mends the ports of Fast DDS in shared memory: those that hang, deafen or delay processes.

Each is described at its function: `remove_torn_ports`, `lost_ports` and `shorten_liveness_pause`.
The files that a process uses come from proc(5): Fast DDS maps its segments, ports and semaphores.
It keeps a port's lock file, PORT_el, open for as long as the process reads the port. A file that
cannot be looked up is left out, and a process that cannot be looked into uses none.
"""

import os
import re
import struct
import time
from collections.abc import Iterator
from contextlib import suppress

from arm_node.workarounds.switch import is_on

OWN_PROCESS = "/proc/self"
"""The folder of this process in proc(5)."""
_PORT_LOCK = re.compile(r"(/.*/fast(?:rtps|dds)_port\d+)_el( \(deleted\))?")
_MAPPED = re.compile(r"/dev/shm/.*fast(?:rtps|dds)_.*")
_DELETED = " (deleted)"


def open_files(process: str = OWN_PROCESS) -> Iterator[str]:
    """Yield the path of each open file of a process; it ends with " (deleted)" if that is so."""
    with suppress(OSError), os.scandir(f"{process}/fd") as entries:
        for entry in entries:
            with suppress(OSError):
                yield os.readlink(entry.path)


def mapped_files(process: str = OWN_PROCESS) -> dict[str, set[int]]:
    """Return the inodes of the mapped files of Fast DDS by their paths.

    A path has several inodes if its file has been replaced.
    """
    text = ""
    with suppress(OSError), open(f"{process}/maps", encoding="utf-8", errors="replace") as file:
        text = file.read()
    mapped: dict[str, set[int]] = {}
    # Splitting every line takes half as long again: a process has a thousand of them.
    for path in _MAPPED.finditer(text):
        inode = text[text.rfind("\n", 0, path.start()) + 1 : path.start()].split()[-1]
        mapped.setdefault(path[0].removesuffix(_DELETED), set()).add(int(inode))
    return mapped


def read_ports(process: str = OWN_PROCESS) -> dict[str, bool]:
    """Return the paths of the ports that a process reads, and whether their lock files exist."""
    matches = map(_PORT_LOCK.fullmatch, open_files(process))
    return {match[1]: not match[2] for match in matches if match}


SHM_FOLDER = "/dev/shm"
LEAST_AGE_S = 3.0
"""A living process finishes a new port within milliseconds."""
_PORT_FILE = re.compile(r"fast(?:rtps|dds)_port\d+")
_HEAD_BYTES = 4096
_STATE = struct.Struct("=I")
_FILLED, _CORRUPTED = 2, 3
"""First number in a file of Boost.Interprocess; it is 0 or 1 until the file is complete."""


def remove_torn_ports(folder: str = SHM_FOLDER) -> list[str]:
    """Remove the ports that were never finished; return their names.

    A process that is killed while Fast DDS creates a port's file leaves it empty. Any process that
    uses the port next then waits for ever for the dead one to finish it, and ignores SIGINT and
    SIGTERM. A related issue is https://github.com/eProsima/Fast-DDS/issues/1144. A process that
    waits already is freed, too: it reads in its file that the port is corrupted, and makes another.
    """
    removed: list[str] = []
    if not is_on("torn_ports"):
        return removed
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            if _PORT_FILE.fullmatch(entry.name) and _is_torn(entry.path):
                with suppress(OSError):
                    _free_those_who_wait(entry.path)
                    os.unlink(entry.path)
                    removed.append(entry.name)
    return removed


def _free_those_who_wait(path: str) -> None:
    with open(path, "r+b", buffering=0) as file:
        os.truncate(file.fileno(), max(os.stat(path).st_size, _HEAD_BYTES))
        os.pwrite(file.fileno(), _STATE.pack(_CORRUPTED), 0)


def _is_torn(path: str) -> bool:
    try:
        if time.time() - os.stat(path).st_mtime < LEAST_AGE_S:
            return False
        with open(path, "rb") as file:
            beginning = file.read(_STATE.size)
    except OSError:
        return False
    return len(beginning) < _STATE.size or _STATE.unpack(beginning)[0] < _FILLED


def lost_ports(process: str = OWN_PROCESS) -> list[str]:
    """Return the paths of the ports that this process reads, but to which nobody can send any more.

    A process that sends to a port without a reader makes the port and removes it again, together
    with its mutex. A simulation does that 100 times a second while it still sends to a participant
    that has ended; after a busy moment it may take 20 s until it knows. If a new process opens the
    same port meanwhile, it may wait for a mutex that is then removed. It goes on although another
    process holds the new mutex, and that one finds the port unfinished and removes it. The new
    process discovers every topic and hears nothing. `discovery.first_node` then makes the node
    again, and with it the ports. No upstream issue is known.

    Call it after creating the process's first node; from any thread.
    """
    ports = read_ports(process) if is_on("lost_ports") else {}
    mapped = mapped_files(process) if ports else {}
    return sorted(
        path
        for path, lock_exists in ports.items()
        if not lock_exists or _inode(path) not in mapped.get(path, set())
    )


def _inode(path: str) -> int | None:
    with suppress(OSError):
        return os.stat(path).st_ino
    return None


PAUSE_MS = 50
"""Longest delay of a sender; a reader without messages wakes at this interval."""

_PORT = struct.Struct("=I")
_NUMBERS = struct.Struct("=IIII")
"""Port number, number of readers, timeout, interval between refreshes (a third of it)."""


def shorten_liveness_pause(process: str = OWN_PROCESS) -> list[str]:
    """Shorten the refresh interval in the ports that this process reads; return their paths.

    Works around https://github.com/eProsima/Fast-DDS/issues/6535. Before a process first sends to a
    shared-memory port, Fast DDS checks that the port has a live reader. If the reader's liveness
    flag has been cleared since its last refresh (every process clears it about once a second), the
    sender sleeps until the next refresh, and the sender may be the thread of a control loop. A
    reader refreshes the flag with each message, and without messages three times in
    `healthy_check_timeout_ms`. By default that is 1000 ms, so a late process waits up to a third of
    a second for each process that it finds.

    A smaller timeout is not a solution. It is also the time after which a reader without processor
    time counts as dead. The sender then replaces the port that is being read, and the reader, once
    it runs again, never receives from processes that start later. At 150 ms this happened to two of
    160 commands on a machine with eight programs on two processors. So the timeout stays, and only
    the interval between two refreshes is changed, in the port itself, where Fast DDS stores the two
    numbers side by side. If they are not found, nothing is changed.

    Call it after creating the process's first node; from any thread.
    """
    changed: list[str] = []
    if not is_on("signs_of_life"):
        return changed
    for path in (path for path, lock_exists in read_ports(process).items() if lock_exists):
        number = int(path.rpartition("port")[2])
        with suppress(OSError), open(path, "r+b", buffering=0) as file:
            at = _find_pause(file.read(_HEAD_BYTES), number)
            if at is not None:
                os.pwrite(file.fileno(), _PORT.pack(PAUSE_MS), at)
                changed.append(path)
    return changed


def _find_pause(head: bytes, number: int) -> int | None:
    """Return the offset of the refresh interval, or None if it is short enough or not found."""
    at = head.find(_PORT.pack(number))
    while 0 <= at <= len(head) - _NUMBERS.size:
        _, _, timeout, pause = _NUMBERS.unpack_from(head, at)
        if pause == timeout // 3 and pause > PAUSE_MS:
            return at + _NUMBERS.size - _PORT.size
        at = head.find(_PORT.pack(number), at + 1)
    return None
