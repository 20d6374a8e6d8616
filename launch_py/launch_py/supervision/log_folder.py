"""The folder of one launch: a log file per process, and what the supervisor itself said."""

from __future__ import annotations

import os
import re
import socket
import time
from collections.abc import Mapping
from pathlib import Path
from typing import BinaryIO

from launch_py.errors import StartError

ESCAPES = re.compile("\x1b\\[[0-9;?]*[ -/]*[@-~]")
"""Terminal control sequences, which have no place in a file."""


def log_root(environ: Mapping[str, str]) -> Path:
    """Return where ROS keeps logs: ROS_LOG_DIR, else $ROS_HOME/log, else ~/.ros/log."""
    if environ.get("ROS_LOG_DIR"):
        return Path(os.path.expanduser(environ["ROS_LOG_DIR"]))
    if environ.get("ROS_HOME"):
        return Path(os.path.expanduser(environ["ROS_HOME"])) / "log"
    if environ.get("HOME"):
        return Path(environ["HOME"]) / ".ros" / "log"
    return Path(environ.get("TMPDIR", "/tmp")) / f"ros-log-{os.getuid()}"


class LogFolder:
    """A fresh folder below the root, with a link `latest` beside it that points to it."""

    def __init__(self, root: Path) -> None:
        stamp = time.strftime("%Y-%m-%d-%H-%M-%S")
        self.path = root / f"{stamp}-{socket.gethostname()}-{os.getpid()}"
        self._files: dict[str, BinaryIO] = {}
        self._generated: list[Path] = []
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise StartError(
                f"cannot make the log folder {self.path}: {reason(error)}; "
                "set ROS_LOG_DIR to a folder that can be written to"
            ) from error
        self._link_latest(root)

    def write(self, name: str, text: str) -> None:
        """Append one line, with the time of day, to the log file `name`.log.

        Raises:
            OSError: the line is lost, the disk may be full; the next one may fit again.
        """
        file = self._files.get(name)
        if file is None:
            path = self.path / f"{_file_name(name)}.log"
            # Unbuffered: what a crash explains must be in the file.
            file = self._files[name] = path.open("ab", buffering=0)
        now_s = time.time()
        stamp = time.strftime("%H:%M:%S", time.localtime(now_s))
        plain = ESCAPES.sub("", text) if "\x1b" in text else text
        file.write(f"{stamp}.{int(now_s % 1 * 1000):03d} {plain}\n".encode(errors="replace"))

    def generate(self, name: str, text: str) -> Path:
        """Write a file that a process reads; it is removed when the folder is closed.

        Raises:
            StartError: it cannot be written.
        """
        path = self.path / _file_name(name)
        self._generated.append(path)
        try:
            path.write_text(text, encoding="utf-8")
        except OSError as error:
            raise StartError(f"cannot write {path}: {reason(error)}") from error
        return path

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
            # A convenience only: a file system without links must not stop the launch.
            temporary.unlink(missing_ok=True)


def reason(error: OSError) -> str:
    """Return why something failed, to be put after a colon."""
    return (error.strerror or str(error)).lower()


def _file_name(name: str) -> str:
    return re.sub(r"[^\w.+-]", "_", name)
