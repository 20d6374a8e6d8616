"""Tells a user's own clients from robots whose node names could collide with a launch.

Looking up the ROS graph delays the start by half a second. A process that only listens, such as a
plotting script, `ros2 topic echo` or RViz, is not worth that delay. What the kernel knows of a
process tells it from a robot.
"""

from __future__ import annotations

import os
from collections.abc import Iterable

from launch_py.fast_dds.participants import ParticipantPorts

LAUNCHED = b"NOTIFY_SOCKET="
"""Every process that `arm launch` starts has this in its environment."""

ROS_ARGUMENTS = b"--ros-args"
"""Every node that `ros2 launch` starts, and every renamed node, has this on its command line."""


def are_bystanders(ports: ParticipantPorts, names: Iterable[str]) -> bool:
    """Return whether no participant on these ports is likely to have a node with one of the names.

    A bystander is a process of this user that no launch has started and whose command line names
    none of the nodes. A participant whose process is unknown is not a bystander.

    Args:
        ports: the ports of the participants.
        names: the names of the nodes, with or without a namespace.
    """
    if ports.owners.keys() != ports.indices:
        return False
    words = {name.rpartition("/")[2].encode() for name in names} - {b""}
    return all(_is_bystander(pid, words) for pids in ports.owners.values() for pid in pids)


def _is_bystander(pid: int, words: set[bytes]) -> bool:
    folder = f"/proc/{pid}"
    try:
        if os.stat(folder).st_uid != os.geteuid() or LAUNCHED in _content(f"{folder}/environ"):
            return False
        command = _content(f"{folder}/cmdline")
    except OSError:
        return False
    return ROS_ARGUMENTS not in command and not any(word in command for word in words)


def _content(path: str) -> bytes:
    with open(path, "rb") as file:
        return file.read()
