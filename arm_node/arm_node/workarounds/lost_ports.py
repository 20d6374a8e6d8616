"""Finds ports in shared memory that this process reads, but to which nobody can send any more.

A process that sends to a port without a reader makes the port and removes it again, together with
its mutex. A simulation does that 100 times a second while it still sends to a participant that has
ended; after a busy moment it may take 20 s until it knows. If a new process opens the same port
meanwhile, it may wait for a mutex that is then removed. It goes on although another process holds
the new mutex, and that one finds the port unfinished and removes it. The new process discovers
every topic and hears nothing.

`discovery.first_node` then makes the node again, and with it the ports. This works around Fast DDS
2.14; no upstream issue is known.
"""

import os
import re
from contextlib import suppress

from arm_node.workarounds.switch import is_on

_OWN_PORT = re.compile(r"(/.*/fastrtps_port\d+)_el( \(deleted\))?")
"""Fast DDS keeps this lock file open for every port that the process reads."""
_DELETED = " (deleted)"


def lost_ports(process: str = "/proc/self") -> list[str]:
    """Return the paths of the lost ports.

    Call it after creating the process's first node; from any thread.

    Args:
        process: the process's folder in proc(5).
    """
    own = _own_ports(process) if is_on("lost_ports") else {}
    mapped = _mapped_ports(process) if own else {}
    return sorted(
        path
        for path, lock_exists in own.items()
        if not lock_exists or _inode(path) not in mapped.get(path, set())
    )


def _own_ports(process: str) -> dict[str, bool]:
    """Return the ports that the process reads, and whether their lock files still exist."""
    ports: dict[str, bool] = {}
    with suppress(OSError), os.scandir(f"{process}/fd") as entries:
        for entry in entries:
            with suppress(OSError):
                match = _OWN_PORT.fullmatch(os.readlink(entry.path))
                if match:
                    ports[match[1]] = not match[2]
    return ports


def _mapped_ports(process: str) -> dict[str, set[int]]:
    """Return the inodes of the mapped ports by path; see proc_pid_maps(5)."""
    mapped: dict[str, set[int]] = {}
    with suppress(OSError), open(f"{process}/maps", encoding="utf-8", errors="replace") as file:
        for line in file:
            if "/fastrtps_port" in line:
                fields = line.rstrip("\n").split(maxsplit=5)
                mapped.setdefault(fields[5].removesuffix(_DELETED), set()).add(int(fields[4]))
    return mapped


def _inode(path: str) -> int | None:
    with suppress(OSError):
        return os.stat(path).st_ino
    return None
