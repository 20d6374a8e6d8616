"""Limits a process to this host in its Fast DDS profile, instead of by an environment variable.

With ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST, rmw_fastrtps adds its own shared-memory and UDP
transports to those of the profile. Each message is then sent twice: in two memory segments to every
subscriber, and in two datagrams to every participant during discovery. Therefore a profile X.xml
may have a twin X_localhost.xml with the same transports, which are themselves limited to this host.

rmw_fastrtps behaves like this since https://github.com/ros2/rmw_fastrtps/pull/653. Made for the
versions in ROS 2 Jazzy and Kilted.
"""

import os
from collections.abc import MutableMapping

from arm_node.workarounds.switch import is_on, uses_fast_dds_3

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
OF_FAST_DDS_2, OF_FAST_DDS_3 = "FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE"
STATIC_PEERS = "ROS_STATIC_PEERS"
LOCALHOST, FROM_PROFILE = "LOCALHOST", "SYSTEM_DEFAULT"
TWIN = "_localhost"


def profile_variable() -> str:
    """Return the variable from which Fast DDS takes a process's profile."""
    return OF_FAST_DDS_3 if uses_fast_dds_3() else OF_FAST_DDS_2


def use_local_profile(environ: MutableMapping[str, str]) -> None:
    """Use the profile's twin if the process is limited to this host.

    Must run before rclpy starts. With ROS_STATIC_PEERS nothing changes, because rmw_fastrtps itself
    contacts these peers. The environment, which rclpy will read, is changed in place.
    """
    variable = profile_variable()
    stem, extension = os.path.splitext(environ.get(variable, ""))
    twin = f"{stem}{TWIN}{extension}"
    if not is_on("local_profile"):
        return
    if environ.get(RANGE) != LOCALHOST or environ.get(STATIC_PEERS) or not os.path.isfile(twin):
        return
    environ[variable] = twin
    environ[RANGE] = FROM_PROFILE


def use_general_profile(environ: MutableMapping[str, str]) -> None:
    """Undo `use_local_profile`, in place, for a child process that chooses its own profile."""
    variable = profile_variable()
    stem, extension = os.path.splitext(environ.get(variable, ""))
    if environ.get(RANGE) != FROM_PROFILE or not stem.endswith(TWIN):
        return
    environ[variable] = stem.removesuffix(TWIN) + extension
    environ[RANGE] = LOCALHOST
