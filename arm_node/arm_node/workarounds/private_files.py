"""Hides the files of the middleware from other users of this machine.

Logs tell what a robot does, and all messages can be read in shared memory. The umask protects logs,
locks and semaphores. Fast DDS sets the permissions of its segments itself, so this module changes
them afterwards. Sending needs write permission, which other users never had.

If this is switched off, only the shared memory keeps the permissions that Fast DDS 2.14 and 3.2
sets. No upstream issue is known.
"""

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from arm_node.workarounds.ports import OWN_PROCESS, mapped_files, open_files
from arm_node.workarounds.switch import is_on

UMASK = 0o077
OWNER_ONLY = 0o600
_SHARED_MEMORY = re.compile(r"/dev/shm/(?:sem\.)?fast(?:rtps|dds)_\w+")


@contextmanager
def made_private() -> Iterator[None]:
    """Create files without permissions for other users while the context lasts."""
    before = os.umask(UMASK)
    try:
        yield
    finally:
        os.umask(before)


def hide_shared_memory(process: str = OWN_PROCESS) -> list[str]:
    """Remove other users' permissions from this process's shared memory; return the paths.

    Call it after creating the process's first node; from any thread.
    """
    changed: list[str] = []
    if not is_on("private_files"):
        return changed
    # Segments and semaphores are mapped, and locks are open.
    used = {*mapped_files(process), *open_files(process)}
    for path in sorted(filter(_SHARED_MEMORY.fullmatch, used)):
        with suppress(OSError):
            status = os.stat(path)
            if status.st_uid == os.geteuid() and status.st_mode & UMASK:
                os.chmod(path, OWNER_ONLY)
                changed.append(path)
    return changed
