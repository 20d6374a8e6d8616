"""Removes ports of shared memory that nobody can open.

A process that is killed in the moment in which Fast DDS makes a port's file leaves it without
content. Whoever is to use the port next, and that may be anybody who starts, then waits without end
for the dead one to finish it, deaf to SIGINT and SIGTERM.
"""

import os
import re
import struct
import time
from contextlib import suppress

SHM_FOLDER = "/dev/shm"
LEAST_AGE_S = 3.0
"""Whoever makes a port has filled it a moment later."""
_PORT = re.compile(r"fastrtps_port\d+")
_STATE = struct.Struct("=I")
_FILLED = 2
"""How a file of Boost.Interprocess begins once it is complete; 0 and 1 stand before."""


def remove_torn_ports(folder: str = SHM_FOLDER) -> list[str]:
    """Remove the ports that were begun and never finished; return their names."""
    removed: list[str] = []
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            if _PORT.fullmatch(entry.name) and _is_torn(entry.path):
                with suppress(OSError):
                    os.unlink(entry.path)
                    removed.append(entry.name)
    return removed


def _is_torn(path: str) -> bool:
    try:
        if time.time() - os.stat(path).st_mtime < LEAST_AGE_S:
            return False
        with open(path, "rb") as file:
            beginning = file.read(_STATE.size)
    except OSError:
        return False
    return len(beginning) < _STATE.size or _STATE.unpack(beginning)[0] < _FILLED
