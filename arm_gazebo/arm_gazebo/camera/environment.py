"""The environment of a camera process: above all, transport that carries large pictures."""

import os
from collections.abc import Mapping
from pathlib import Path

from arm_description.errors import ResourceNotFoundError
from arm_description.resources import resolve_uri, share_folders
from arm_gazebo.feed.child_process import NOT_INHERITED
from arm_node.local_profile import use_general_profile

PROFILE_VARIABLES = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")
LARGE_PROFILE_URI = "package://arm_gazebo/config/dds_images.xml"
SMALL_PROFILE_URI = "package://arm_gazebo/config/dds_images_small.xml"
ROOM_FOR_LARGE_BYTES = 128 << 20
"""Free shared memory that the large segment (32 MiB) is taken with; Docker's default is 64 MiB."""
LAUNCHER = "launch_py"


def camera_environment(environ: Mapping[str, str], shm: str = "/dev/shm") -> dict[str, str]:
    """Return the environment for a camera process.

    Args:
        environ: the simulation's own environment.
        shm: folder of the shared memory, whose free space decides on the profile.
    """
    own = {name: value for name, value in environ.items() if name not in NOT_INHERITED}
    # Otherwise importing mujoco loads a window toolkit.
    own["MUJOCO_GL"] = "off"
    use_general_profile(own)
    profile = _profile(own, shm)
    if profile is not None:
        own[PROFILE_VARIABLES[0]] = str(profile)
    return own


def _profile(environ: Mapping[str, str], shm: str) -> Path | None:
    """Return the profile to use, None to leave what is."""
    if any(environ.get(name) and not _launchers(environ[name]) for name in PROFILE_VARIABLES):
        return None
    try:
        roomy = _free_bytes(shm) >= ROOM_FOR_LARGE_BYTES
        return resolve_uri(LARGE_PROFILE_URI if roomy else SMALL_PROFILE_URI)
    except ResourceNotFoundError:
        return None


def _launchers(profile: str) -> bool:
    """Return whether a profile is the launcher's general one, not one that the user chose."""
    folders = (folder / LAUNCHER for folder in share_folders())
    return any(
        Path(profile).is_relative_to(folder)
        or Path(profile).resolve().is_relative_to((folder / "config").resolve())
        for folder in folders
        if folder.exists()
    )


def _free_bytes(folder: str) -> int:
    try:
        status = os.statvfs(folder)
    except OSError:
        return 0
    return status.f_bavail * status.f_frsize
