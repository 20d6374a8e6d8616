"""Removes unfinished shared-memory ports, which would hang every process that opens them.

A process that is killed while Fast DDS creates a port's file leaves it empty. Any process that uses
the port next then waits for ever for the dead one to finish it, and ignores SIGINT and SIGTERM.

Works around this in Fast DDS 2.14. A related issue is
https://github.com/eProsima/Fast-DDS/issues/1144.
"""

import os
import re
import struct
import time
from contextlib import suppress

from arm_node.workarounds.switch import is_on

SHM_FOLDER = "/dev/shm"
LEAST_AGE_S = 3.0
"""A living process finishes a new port within milliseconds."""
_PORT = re.compile(r"fastrtps_port\d+")
_STATE = struct.Struct("=I")
_FILLED = 2
"""First number in a complete file of Boost.Interprocess; it is 0 or 1 before that."""


def remove_torn_ports(folder: str = SHM_FOLDER) -> list[str]:
    """Remove the ports that were never finished; return their names."""
    removed: list[str] = []
    if not is_on("torn_ports"):
        return removed
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
