"""The environment of launched processes, and where they write their log files."""

from __future__ import annotations

import os
import socket
import sys
import time
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from launch_py.system.dds_profile import RANGE, keep_to_loopback, shipped_profile
from launch_py.system.packages import ament_prefixes


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


BOOTSTRAP_GUARD = "_ROS_WHEELS_BOOTSTRAP_COMPLETE"
LIBRARY_PATH = "LD_LIBRARY_PATH"


def default_environment(
    environ: Mapping[str, str],
    log_folder: Path | None,
    notify_address: str | None,
    colours: bool,
) -> dict[str, str]:
    """Return the variables that the supervisor adds to the environment of every process.

    Variables that the user has set keep their value; AMENT_PREFIX_PATH is extended. NOTIFY_SOCKET
    is always the supervisor's own, because an inherited one belongs to the process that started the
    supervisor. `log_folder` is for log files that the processes write themselves; `colours` is
    whether the output goes to a terminal in colour.
    """
    defaults = {RANGE: "LOCALHOST", "PYTHONUNBUFFERED": "1", **shipped_profile(environ)}
    if log_folder is not None:
        defaults["ROS_LOG_DIR"] = str(log_folder)
    if colours:
        defaults["RCUTILS_COLORIZED_OUTPUT"] = "1"
    added = {name: value for name, value in defaults.items() if name not in environ}
    added["AMENT_PREFIX_PATH"] = os.pathsep.join(ament_prefixes(environ))
    if notify_address is not None:
        added["NOTIFY_SOCKET"] = notify_address
    return added


def for_program(program: str, environ: Mapping[str, str]) -> dict[str, str]:
    """Return the environment adapted to a program.

    The ROS wheels restart every Python once to set LD_LIBRARY_PATH, and set a guard variable to
    mark that. A child that runs this same Python inherits both, which saves it the restart (25 ms).
    Any other program must get neither: a Python of another environment would load the wrong
    libraries. A program whose discovery is limited to this host gets the DDS profile that listens
    on the loopback interface only.
    """
    adapted = dict(environ)
    keep_to_loopback(adapted)
    if program == sys.executable or BOOTSTRAP_GUARD not in adapted:
        return adapted
    del adapted[BOOTSTRAP_GUARD]
    prefix = os.path.join(sys.prefix, "")
    folders = adapted.pop(LIBRARY_PATH, "").split(os.pathsep)
    foreign = [folder for folder in folders if folder and not folder.startswith(prefix)]
    if foreign:
        adapted[LIBRARY_PATH] = os.pathsep.join(foreign)
    return adapted
