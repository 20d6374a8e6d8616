"""Names of topics, services, actions and nodes."""

import os


def absolute_name(name: str) -> str:
    """Return a name as the graph has it: `joint_states` is `/joint_states`."""
    return name if name.startswith("/") else f"/{name}"


def is_hidden(name: str) -> bool:
    """Return whether a name is hidden: a part of it begins with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))


def this_domain() -> str:
    """Say which ROS domain was looked at, for messages about what is not there."""
    return f"ROS_DOMAIN_ID={os.environ.get('ROS_DOMAIN_ID') or 0}"
