"""Shows those who send to this process through shared memory sooner that it is alive.

Who first sends to a port of Fast DDS's shared memory makes sure that somebody reads there. Where
the reader's last sign of life has been counted already (every process counts about once a second)
the sender sleeps until the next one, and that may be the thread of a control loop. A reader gives
one with each message, and without messages three times in `healthy_check_timeout_ms`. By default
that is 1000 ms: whoever comes late loses up to a third of a second to each process that it finds.

A smaller timeout is no cure: it is also the time after which a reader that was kept from the
processor is taken for dead. The sender then puts a new port in place of the one being read, and
the reader, alive again, stays deaf to all who come later. At 150 ms that befell two of 160
commands on a machine with eight programs for two processors.

So the timeout stays, and only the pause between two signs of life is set, in the port itself, where
Fast DDS keeps both numbers side by side. Where they are not found, nothing is changed.
"""

import os
import re
import struct
from contextlib import suppress

PAUSE_MS = 50
"""So long at most may a sender be held up; a reader without messages wakes as often."""

_HEAD_BYTES = 4096
_OWN_PORT = re.compile(r"(.*/fastrtps_port(\d+))_el")
"""Fast DDS holds this lock open for every port that the process reads."""
_PORT = struct.Struct("=I")
_NUMBERS = struct.Struct("=IIII")
"""Number of the port, number of readers, timeout, pause between signs of life (a third of it)."""


def show_life_often(open_files: str = "/proc/self/fd") -> list[str]:
    """Shorten the pause in the ports that this process reads; return their paths.

    Call it when the process's first node is there; from any thread.

    Args:
        open_files: folder with a link for every file that the process has open.
    """
    changed: list[str] = []
    for path, number in _own_ports(open_files):
        with suppress(OSError), open(path, "r+b", buffering=0) as file:
            at = _find_pause(file.read(_HEAD_BYTES), number)
            if at is not None:
                os.pwrite(file.fileno(), _PORT.pack(PAUSE_MS), at)
                changed.append(path)
    return changed


def _own_ports(open_files: str) -> list[tuple[str, int]]:
    ports: list[tuple[str, int]] = []
    with suppress(OSError), os.scandir(open_files) as entries:
        for entry in entries:
            with suppress(OSError):
                match = _OWN_PORT.fullmatch(os.readlink(entry.path))
                if match:
                    ports.append((match.group(1), int(match.group(2))))
    return ports


def _find_pause(head: bytes, number: int) -> int | None:
    """Return where the pause stands if it is there and longer than it should be."""
    at = head.find(_PORT.pack(number))
    while 0 <= at <= len(head) - _NUMBERS.size:
        _, _, timeout, pause = _NUMBERS.unpack_from(head, at)
        if pause == timeout // 3 and pause > PAUSE_MS:
            return at + _NUMBERS.size - _PORT.size
        at = head.find(_PORT.pack(number), at + 1)
    return None
