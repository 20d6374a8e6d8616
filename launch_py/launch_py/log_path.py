"""Where a launch writes its log files."""

from __future__ import annotations

import os
import socket
import time
from collections.abc import Mapping
from functools import cache
from pathlib import Path


def log_root(environ: Mapping[str, str]) -> Path:
    """Return the folder of ROS's logs: ROS_LOG_DIR, else $ROS_HOME/log, else ~/.ros/log."""
    if environ.get("ROS_LOG_DIR"):
        return Path(os.path.expanduser(environ["ROS_LOG_DIR"]))
    if environ.get("ROS_HOME"):
        return Path(os.path.expanduser(environ["ROS_HOME"])) / "log"
    if environ.get("HOME"):
        return Path(environ["HOME"]) / ".ros" / "log"
    return Path(environ.get("TMPDIR", "/tmp")) / f"ros-log-{os.getuid()}"


@cache
def launch_name() -> str:
    """Return the name of this process's log folder, known before the folder exists."""
    stamp = time.strftime("%Y-%m-%d-%H-%M-%S")
    return f"{stamp}-{socket.gethostname()}-{os.getpid()}"
