"""The environment that the launched processes get."""

import os
import sys
from collections.abc import Mapping
from pathlib import Path

from launch_py.errors import NotFoundError
from launch_py.packages import Packages, ament_prefixes

BOOTSTRAP_GUARD = "_ROS_WHEELS_BOOTSTRAP_COMPLETE"
LIBRARY_PATH = "LD_LIBRARY_PATH"


def default_environment(
    environ: Mapping[str, str],
    log_folder: Path | None,
    notify_address: str | None,
    colours: bool,
) -> dict[str, str]:
    """Return what the supervisor adds to the environment of every process.

    What the user has set stays as it is; AMENT_PREFIX_PATH is completed. NOTIFY_SOCKET is always
    the supervisor's own: an inherited one belongs to whoever started the supervisor.

    Args:
        environ: the supervisor's own environment.
        log_folder: where the processes' own log files go.
        notify_address: the supervisor's notification socket.
        colours: whether a terminal shows the output, in colours.
    """
    defaults = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "PYTHONUNBUFFERED": "1"}
    if log_folder is not None:
        defaults["ROS_LOG_DIR"] = str(log_folder)
    profile = dds_profile(environ)
    if profile is not None:
        defaults["FASTRTPS_DEFAULT_PROFILES_FILE"] = str(profile)
    if colours:
        defaults["RCUTILS_COLORIZED_OUTPUT"] = "1"
    added = {name: value for name, value in defaults.items() if name not in environ}
    added["AMENT_PREFIX_PATH"] = os.pathsep.join(ament_prefixes(environ))
    if notify_address is not None:
        added["NOTIFY_SOCKET"] = notify_address
    return added


def dds_profile(environ: Mapping[str, str]) -> Path | None:
    """Return the shipped Fast DDS profile, None where launch_py is not installed with its data."""
    try:
        path = Packages(environ).share_folder("launch_py") / "config" / "dds_profile.xml"
    except NotFoundError:
        return None
    return path if path.is_file() else None


def for_program(program: str, environ: Mapping[str, str]) -> dict[str, str]:
    """Return the environment adapted to the program that gets it.

    The ROS wheels restart every Python once to set LD_LIBRARY_PATH, and mark that with a guard
    variable. This same Python may keep both, which saves it the restart (25 ms); any other program
    must get neither: a Python of another environment would use the wrong libraries.
    """
    adapted = dict(environ)
    if program == sys.executable or BOOTSTRAP_GUARD not in adapted:
        return adapted
    del adapted[BOOTSTRAP_GUARD]
    own = os.path.join(sys.prefix, "")
    folders = adapted.pop(LIBRARY_PATH, "").split(os.pathsep)
    foreign = [folder for folder in folders if folder and not folder.startswith(own)]
    if foreign:
        adapted[LIBRARY_PATH] = os.pathsep.join(foreign)
    return adapted
