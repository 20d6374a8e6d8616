"""Refreshes this process's liveness flag in Fast DDS's shared memory more often.

Works around https://github.com/eProsima/Fast-DDS/issues/6535, in Fast DDS 2.14.

Before a process first sends to a shared-memory port, Fast DDS checks that the port has a live
reader. If the reader's liveness flag has been cleared since its last refresh (every process clears
it about once a second), the sender sleeps until the next refresh, and the sender may be the thread
of a control loop. A reader refreshes the flag with each message, and without messages three times
in `healthy_check_timeout_ms`. By default that is 1000 ms, so a late process waits up to a third of
a second for each process that it finds.

A smaller timeout is not a solution. It is also the time after which a reader without processor time
counts as dead. The sender then replaces the port that is being read, and the reader, once it runs
again, never receives from processes that start later. At 150 ms this happened to two of 160
commands on a machine with eight programs on two processors.

So the timeout stays, and only the interval between two refreshes is changed, in the port itself,
where Fast DDS stores the two numbers side by side. If they are not found, nothing is changed.
"""

import os
import struct
from contextlib import suppress

from arm_node.workarounds.switch import is_on
from arm_node.workarounds.used_files import OWN_PROCESS, read_ports

PAUSE_MS = 50
"""Longest delay of a sender; a reader without messages wakes at this interval."""

_HEAD_BYTES = 4096
_PORT = struct.Struct("=I")
_NUMBERS = struct.Struct("=IIII")
"""Port number, number of readers, timeout, interval between refreshes (a third of it)."""


def shorten_liveness_pause(process: str = OWN_PROCESS) -> list[str]:
    """Shorten the refresh interval in the ports that this process reads; return their paths.

    Call it after creating the process's first node; from any thread.

    Args:
        process: the process's folder in proc(5).
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
