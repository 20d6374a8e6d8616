"""Removes the files that Fast DDS leaves in /dev/shm when a supervised process is killed.

A participant that shuts down removes its own files; one that is killed leaves up to eight.
Who owns a segment is looked up when its lock file appears (inotify). After the owner's death the
files are removed, unless another process uses them.
"""

from __future__ import annotations

import os
from collections.abc import Callable

from launch_py.fast_dds.removal import remove_unused
from launch_py.fast_dds.shared_memory import (
    SHM_FOLDER,
    lock_files,
    lock_names,
    lock_owners,
)


class SharedMemoryLedger:
    """Keeps a list of the segments that supervised processes own; belongs to the loop's thread.

    Args:
        is_ours: tells whether a process id belongs to a supervised process or a descendant.
        folder: where the segments are.
    """

    def __init__(self, is_ours: Callable[[int], bool], folder: str = SHM_FOLDER) -> None:
        self._is_ours = is_ours
        self._folder = folder
        self._owned: set[str] = set()

    def observe(self) -> None:
        """Add the segments that supervised processes own now."""
        files = lock_files(self._folder)
        owners = lock_owners(self._folder) if files else {}
        for stem, inode in files.items():
            if any(self._is_ours(pid) for pid in owners.get(inode, ())):
                self._owned.add(stem)

    def sweep(self) -> list[str]:
        """Remove the listed segments that have no living owner; return their names.

        A removed segment stays on the list. A process that still sends to a dead one creates the
        segment of its port again, and does not remove it at its own end.
        """
        existing = [stem for stem in sorted(self._owned) if self._exists(stem)]
        return remove_unused(existing, self._folder) if existing else []

    def _exists(self, stem: str) -> bool:
        names = (stem, *lock_names(stem))
        return any(os.path.exists(os.path.join(self._folder, name)) for name in names)
