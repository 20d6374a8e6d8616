"""The environment of launched processes, and where they write their log files."""

from __future__ import annotations

import os
import socket
import sys
import time
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from launch_py.errors import NotFoundError
from launch_py.system.packages import Packages, ament_prefixes


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
RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
STATIC_PEERS = "ROS_STATIC_PEERS"
PROFILE = "FASTRTPS_DEFAULT_PROFILES_FILE"
FAST_DDS = "rmw_fastrtps"


def default_environment(
    environ: Mapping[str, str],
    log_folder: Path | None,
    notify_address: str | None,
    colours: bool,
) -> dict[str, str]:
    """Return the variables that the supervisor adds to the environment of every process.

    Variables that the user has set keep their value; AMENT_PREFIX_PATH is extended. NOTIFY_SOCKET
    is always the supervisor's own, because an inherited one belongs to the process that started
    the supervisor.

    Args:
        environ: the supervisor's own environment.
        log_folder: the folder for log files that the processes write themselves.
        notify_address: the address of the supervisor's notification socket.
        colours: whether the output goes to a terminal in colour.
    """
    defaults = {RANGE: "LOCALHOST", "PYTHONUNBUFFERED": "1"}
    if log_folder is not None:
        defaults["ROS_LOG_DIR"] = str(log_folder)
    profile = dds_profile(environ)
    if profile is not None:
        defaults[PROFILE] = str(profile)
    if colours:
        defaults["RCUTILS_COLORIZED_OUTPUT"] = "1"
    added = {name: value for name, value in defaults.items() if name not in environ}
    added["AMENT_PREFIX_PATH"] = os.pathsep.join(ament_prefixes(environ))
    if notify_address is not None:
        added["NOTIFY_SOCKET"] = notify_address
    return added


def dds_profile(environ: Mapping[str, str]) -> Path | None:
    """Return the shipped Fast DDS profile, or None if launch_py is installed without its data."""
    try:
        path = Packages(environ).share_folder("launch_py") / "config" / "dds_profile.xml"
    except NotFoundError:
        return None
    return path if path.is_file() else None


def for_program(program: str, environ: Mapping[str, str]) -> dict[str, str]:
    """Return the environment adapted to a program.

    The ROS wheels restart every Python once to set LD_LIBRARY_PATH, and set a guard variable to
    mark that. A child that runs this same Python inherits both, which saves it the restart (25 ms).
    Any other program must get neither: a Python of another environment would load the wrong
    libraries. A program whose discovery is limited to this host gets the DDS profile that listens
    on the loopback interface only.
    """
    adapted = dict(environ)
    _keep_to_loopback(adapted)
    if program == sys.executable or BOOTSTRAP_GUARD not in adapted:
        return adapted
    del adapted[BOOTSTRAP_GUARD]
    prefix = os.path.join(sys.prefix, "")
    folders = adapted.pop(LIBRARY_PATH, "").split(os.pathsep)
    foreign = [folder for folder in folders if folder and not folder.startswith(prefix)]
    if foreign:
        adapted[LIBRARY_PATH] = os.pathsep.join(foreign)
    return adapted


def _keep_to_loopback(environ: dict[str, str]) -> None:
    """Replace a profile by its `_localhost` variant if the discovery range is LOCALHOST.

    rmw_fastrtps listens on every network interface even with LOCALHOST, and answers any host that
    names this one in ROS_STATIC_PEERS. The variant has a whitelist of interfaces. It also states
    the meaning of LOCALHOST itself, so that rmw_fastrtps adds no transport of its own. The suite's
    own nodes do the same (`arm_node.workarounds.local_profile`); this covers all other programs.
    ARM_WITHOUT switches both off.
    """
    switched_off = {word.strip() for word in environ.get("ARM_WITHOUT", "").split(",")}
    if not switched_off.isdisjoint({"local_profile", "all"}):
        return
    stem, extension = os.path.splitext(environ.get(PROFILE, ""))
    variant = f"{stem}_localhost{extension}"
    local = environ.get(RANGE) == "LOCALHOST" and not environ.get(STATIC_PEERS)
    fast_dds = (environ.get("RMW_IMPLEMENTATION") or FAST_DDS).startswith(FAST_DDS)
    if local and fast_dds and os.path.isfile(variant):
        environ[PROFILE] = variant
        environ[RANGE] = "SYSTEM_DEFAULT"
