"""Keeps a process to this host by its Fast DDS profile, not beside it.

Told LOCALHOST, rmw_fastrtps adds shared memory and UDP of its own to the transports that a profile
has. Each message then goes out twice: in two memory segments to every subscriber, in two datagrams
to every participant that is to be discovered. So a profile X.xml may have a twin X_localhost.xml
with the same transports, which says itself what LOCALHOST means.
"""

import os
from collections.abc import MutableMapping

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
PROFILE = "FASTRTPS_DEFAULT_PROFILES_FILE"
STATIC_PEERS = "ROS_STATIC_PEERS"
LOCALHOST, FROM_PROFILE = "LOCALHOST", "SYSTEM_DEFAULT"
TWIN = "_localhost"


def use_local_profile(environ: MutableMapping[str, str]) -> None:
    """Take the twin of the profile in use where the process is to keep to this host.

    Must run before rclpy starts. Peers by name stay with rmw_fastrtps, which looks for them itself.

    Args:
        environ: what rclpy will go by; changed in place.
    """
    stem, extension = os.path.splitext(environ.get(PROFILE, ""))
    twin = f"{stem}{TWIN}{extension}"
    if environ.get(RANGE) != LOCALHOST or environ.get(STATIC_PEERS) or not os.path.isfile(twin):
        return
    environ[PROFILE] = twin
    environ[RANGE] = FROM_PROFILE


def use_general_profile(environ: MutableMapping[str, str]) -> None:
    """Undo `use_local_profile`, for a child process that has a profile of its own.

    Args:
        environ: of the child; changed in place.
    """
    stem, extension = os.path.splitext(environ.get(PROFILE, ""))
    if environ.get(RANGE) != FROM_PROFILE or not stem.endswith(TWIN):
        return
    environ[PROFILE] = stem.removesuffix(TWIN) + extension
    environ[RANGE] = LOCALHOST
