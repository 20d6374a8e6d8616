"""The log files of one launch, in a folder of their own and limited in size."""

from __future__ import annotations

import os
import re
import time
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

from launch_py.errors import StartError
from launch_py.printable import printable, without_colours
from launch_py.system.child_environment import launch_name

OWNER_ONLY = 0o600
"""Logs are private to the user, because they may hold secrets."""


class _LogFile:
    """Appends lines. A full file becomes NAME.1, in place of an older one, and a new one begins.

    `limit_bytes` is the largest total size of the two files.
    """

    def __init__(self, path: Path, limit_bytes: int) -> None:
        self._path = path
        self._half_bytes = limit_bytes // 2
        self._file = self._open()
        self._size = os.fstat(self._file.fileno()).st_size

    def append(self, line: bytes) -> None:
        """Write a line.

        Raises:
            OSError: the line is lost, for example because the disk is full; later lines may fit.
        """
        if self._size and self._size + len(line) > self._half_bytes:
            self._rotate()
        self._size += self._file.write(line)

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _open(self) -> BinaryIO:
        fd = os.open(self._path, os.O_WRONLY | os.O_APPEND | os.O_CREAT | os.O_CLOEXEC, OWNER_ONLY)
        # Unbuffered, because the last lines before a crash must reach the file.
        return open(fd, "ab", buffering=0)

    def _rotate(self) -> None:
        self._path.replace(older(self._path))
        self._file.close()
        self._file = self._open()
        self._size = 0


def trim(path: Path, limit_bytes: int) -> None:
    """Truncate a file that another process appends to; its newest half moves to NAME.1.

    The other process must open the file for appending, as ROS's loggers do. Lines that it writes
    during the truncation are lost.

    Raises:
        OSError: the file cannot be read or written.
    """
    half = limit_bytes // 2
    if path.stat().st_size <= half:
        return
    with path.open("rb") as file:
        file.seek(-half, os.SEEK_END)
        newest = file.read(half)
        os.truncate(path, 0)
    fd = os.open(older(path), os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, OWNER_ONLY)
    with open(fd, "wb") as file:
        file.write(newest)


def older(path: Path) -> Path:
    """Return the path of the older part of a log file."""
    return path.with_name(f"{path.name}.1")


MIB = 1024 * 1024
DEFAULT_LIMIT_BYTES = 50 * MIB


class LogFolder:
    """A new folder below the root that only its owner can read; the link `latest` points to it.

    `limit_bytes` is the largest total size of a process's log file and its older part.
    """

    def __init__(self, root: Path, limit_bytes: int = DEFAULT_LIMIT_BYTES) -> None:
        self.path = root / launch_name()
        self._limit_bytes = limit_bytes
        self._files: dict[str, _LogFile] = {}
        self._generated: list[Path] = []
        try:
            self.path.mkdir(mode=0o700, parents=True, exist_ok=True)
        except OSError as error:
            raise StartError(
                f"cannot make the log folder {self.path}: {reason(error)}; "
                "set ROS_LOG_DIR to a folder that can be written to"
            ) from error
        self._link_latest(root)

    def write(self, name: str, text: str) -> None:
        """Append one line, with the time of day, to the log file `name`.log.

        Raises:
            OSError: the line is lost, for example because the disk is full; later lines may fit.
        """
        file = self._files.get(name)
        if file is None:
            path = self.path / f"{_file_name(name)}.log"
            file = self._files[name] = _LogFile(path, self._limit_bytes)
        now_s = time.time()
        stamp = time.strftime("%H:%M:%S", time.localtime(now_s))
        plain = printable(without_colours(text))
        file.append(f"{stamp}.{int(now_s % 1 * 1000):03d} {plain}\n".encode(errors="replace"))

    def generate(self, name: str, text: str) -> Path:
        """Write a file for a process to read; `close` removes it.

        Raises:
            StartError: the file cannot be written.
        """
        path = self.path / _file_name(name)
        self._generated.append(path)
        try:
            fd = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, OWNER_ONLY)
            with open(fd, "w", encoding="utf-8") as file:
                file.write(text)
        except OSError as error:
            raise StartError(f"cannot write {path}: {reason(error)}") from error
        return path

    def trim_others(self) -> None:
        """Trim the log files that the processes themselves write to this folder, as rcl does."""
        own = {f"{_file_name(name)}.log" for name in self._files}
        with suppress(OSError):
            for path in self.path.glob("*.log"):
                if path.name not in own:
                    with suppress(OSError):
                        trim(path, self._limit_bytes)

    def close(self) -> None:
        """Remove the generated files and close the log files."""
        for path in self._generated:
            path.unlink(missing_ok=True)
        for file in self._files.values():
            file.close()

    def _link_latest(self, root: Path) -> None:
        temporary = root / f".latest-{os.getpid()}"
        try:
            temporary.symlink_to(self.path.name)
            temporary.replace(root / "latest")
        except OSError:
            # The link is only a convenience: a file system without links must not stop the launch.
            temporary.unlink(missing_ok=True)


def reason(error: OSError) -> str:
    """Return the reason of an error, for a message in which it follows a colon."""
    return (error.strerror or str(error)).lower()


def _file_name(name: str) -> str:
    return re.sub(r"[^\w.+-]", "_", name)
