"""Is there room in the shared memory, through which Fast DDS and the cameras send?"""

import fcntl
import os
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from arm_cli.doctor.finding import Finding

NAME = "shared memory"
NEEDED_BYTES = 8 << 20
ROOMY_BYTES = 128 << 20
"""Below this, cameras send with smaller buffers; Docker gives 64 MiB."""
LEAST_AGE_S = 30.0
"""Whoever makes a segment locks it a moment later."""
PREFIX, LOCK_SUFFIX = "fastrtps_", "_el"


@dataclass(frozen=True, slots=True)
class SharedMemory:
    """Looks at the folder of the shared memory."""

    folder: Path = Path("/dev/shm")

    def examine(self) -> Finding:
        """Write to it, and look at the space and at what dead processes left there."""
        try:
            with tempfile.TemporaryFile(dir=self.folder) as file:
                file.write(b"0")
            status = os.statvfs(self.folder)
        except OSError as error:
            return Finding.error(
                NAME,
                f"{self.folder} cannot be written to: {error.strerror}",
                f"sudo mount -o remount,rw,mode=1777 {self.folder}; in a container: --shm-size=1g",
            )
        return self._judge(status.f_bavail * status.f_frsize, self._leftovers())

    def _judge(self, free_bytes: int, leftovers: list[str]) -> Finding:
        free = f"{free_bytes >> 20} MiB free in {self.folder}"
        more = f"sudo mount -o remount,size=1g {self.folder}; in a container: --shm-size=1g"
        if free_bytes < NEEDED_BYTES:
            return Finding.error(NAME, f"only {free}", more)
        if free_bytes < ROOMY_BYTES:
            return Finding.warning(NAME, f"{free}: large pictures may be lost", more)
        if leftovers:
            return Finding.warning(
                NAME,
                f"{free}; {len(leftovers)} segments of killed ROS processes are left there, "
                f"such as {leftovers[0]}",
                f"when no ROS program runs: rm -f {self.folder}/{PREFIX}* "
                f"{self.folder}/sem.{PREFIX}*",
            )
        return Finding.ok(NAME, free)

    def _leftovers(self) -> list[str]:
        locks = sorted(self.folder.glob(f"{PREFIX}*{LOCK_SUFFIX}"))
        return [lock.name.removesuffix(LOCK_SUFFIX) for lock in locks if _is_abandoned(lock)]


def _is_abandoned(lock: Path) -> bool:
    """Return whether nobody holds the lock that a segment's owner holds while it lives."""
    try:
        if time.time() - lock.stat().st_mtime < LEAST_AGE_S:
            return False
        descriptor = os.open(lock, os.O_RDONLY)
    except OSError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except OSError:
        return False
    finally:
        os.close(descriptor)
    return True
