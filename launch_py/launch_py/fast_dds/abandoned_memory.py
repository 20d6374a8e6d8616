"""Removes what dead processes of this user left in Fast DDS's shared memory.

A launch whose supervisor was killed cannot remove its own files, because its list of them is lost
(see `ledger`). The owner of a file is then not known, but the kernel knows whether it is used.
"""

from __future__ import annotations

import os
import re
from contextlib import suppress

from launch_py.fast_dds.removal import remove_unused
from launch_py.fast_dds.shared_memory import SHM_FOLDER, locked_segments, mutex_file

_FILE = re.compile(r"(?:sem\.)?(fastrtps_(?:port\d+|[0-9a-f]+))(?:_[es]l|_mutex)?")


def remove_abandoned(folder: str = SHM_FOLDER) -> list[str]:
    """Remove the files of this user that no process uses; return their names."""
    locked = locked_segments(folder)
    abandoned = [
        stem
        for stem, names in _own_segments(folder).items()
        # Mutexes alone stay while a participant lives; see `remove_unused`.
        if stem not in locked and not (locked and names == {mutex_file(stem)})
    ]
    return remove_unused(abandoned, folder) if abandoned else []


def _own_segments(folder: str) -> dict[str, set[str]]:
    """Return the names of this user's files by segment."""
    segments: dict[str, set[str]] = {}
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            match = _FILE.fullmatch(entry.name)
            with suppress(OSError):
                if match and entry.stat(follow_symlinks=False).st_uid == os.geteuid():
                    segments.setdefault(match[1], set()).add(entry.name)
    return segments
