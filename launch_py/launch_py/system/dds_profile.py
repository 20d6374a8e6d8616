"""The Fast DDS profile of launched processes, for the version of Fast DDS that they load.

Fast DDS 3, ROS 2 Kilted's, takes its profile from another variable than Fast DDS 2, Jazzy's, and
drops a whole file for one element that only 2 has.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from contextlib import suppress

from launch_py.errors import NotFoundError
from launch_py.system.packages import Packages

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
STATIC_PEERS = "ROS_STATIC_PEERS"
OF_FAST_DDS_2 = "FASTRTPS_DEFAULT_PROFILES_FILE"
OF_FAST_DDS_3 = "FASTDDS_DEFAULT_PROFILES_FILE"
FAST_DDS = "rmw_fastrtps"
_FIRST_ON_FAST_DDS_3 = 9
"""The first major version of rmw_fastrtps that uses Fast DDS 3."""
_MAJOR = re.compile(r"<version[^>]*>\s*(\d+)")


def profile_variables(environ: Mapping[str, str]) -> tuple[str, ...]:
    """Return the variables from which Fast DDS takes a profile; the suite sets the first.

    rmw_fastrtps 9 still reads the old one, too, and prints a warning.
    """
    uses_3 = _major_version(environ) >= _FIRST_ON_FAST_DDS_3
    return (OF_FAST_DDS_3, OF_FAST_DDS_2) if uses_3 else (OF_FAST_DDS_2,)


def shipped_profile(environ: Mapping[str, str]) -> dict[str, str]:
    """Return the variable that sets the shipped profile.

    Empty if the user has set a profile, or if launch_py is installed without its data.
    """
    variables = profile_variables(environ)
    name = "dds_profile_fast_dds_3.xml" if OF_FAST_DDS_3 in variables else "dds_profile.xml"
    with suppress(NotFoundError):
        path = Packages(environ).share_folder("launch_py") / "config" / name
        if path.is_file() and not any(variable in environ for variable in variables):
            return {variables[0]: str(path)}
    return {}


def keep_to_loopback(environ: dict[str, str]) -> None:
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
    variable = profile_variables(environ)[0]
    stem, extension = os.path.splitext(environ.get(variable, ""))
    variant = f"{stem}_localhost{extension}"
    local = environ.get(RANGE) == "LOCALHOST" and not environ.get(STATIC_PEERS)
    fast_dds = (environ.get("RMW_IMPLEMENTATION") or FAST_DDS).startswith(FAST_DDS)
    if local and fast_dds and os.path.isfile(variant):
        environ[variable] = variant
        environ[RANGE] = "SYSTEM_DEFAULT"


def _major_version(environ: Mapping[str, str]) -> int:
    """Return the major version of rmw_fastrtps; 0 if it is unknown."""
    with suppress(NotFoundError, OSError, ValueError):
        manifest = Packages(environ).share_folder(f"{FAST_DDS}_cpp") / "package.xml"
        found = _MAJOR.search(manifest.read_text(encoding="utf-8"))
        return int(found[1]) if found else 0
    return 0
