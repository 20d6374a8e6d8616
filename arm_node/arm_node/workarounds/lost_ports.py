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
from contextlib import suppress

from arm_node.workarounds.switch import is_on
from arm_node.workarounds.used_files import OWN_PROCESS, mapped_files, read_ports


def lost_ports(process: str = OWN_PROCESS) -> list[str]:
    """Return the paths of the lost ports.

    Call it after creating the process's first node; from any thread.

    Args:
        process: the process's folder in proc(5).
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
