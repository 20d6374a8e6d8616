"""Lists the files of Fast DDS that a process uses, from proc(5).

Fast DDS maps its segments, ports and semaphores. It keeps a port's lock file, PORT_el, open for as
long as the process reads the port.

A file that cannot be looked up is left out, and a process that cannot be looked into uses none.
"""

import os
import re
from collections.abc import Iterator
from contextlib import suppress

OWN_PROCESS = "/proc/self"
_PORT_LOCK = re.compile(r"(/.*/fastrtps_port\d+)_el( \(deleted\))?")
_MAPPED = re.compile(r"/dev/shm/.*fastrtps_.*")
_DELETED = " (deleted)"


def open_files(process: str = OWN_PROCESS) -> Iterator[str]:
    """Yield the path of each open file of a process; it ends with " (deleted)" if that is so.

    Args:
        process: the process's folder in proc(5).
    """
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
