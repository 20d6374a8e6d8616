"""Names of topics, services, actions and nodes."""

import os


def absolute_name(name: str) -> str:
    """Return a name as the graph shows it: `joint_states` becomes `/joint_states`."""
    return name if name.startswith("/") else f"/{name}"


def is_hidden(name: str) -> bool:
    """Return whether a name is hidden: whether a part of it begins with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))


def this_domain() -> str:
    """Return the ROS domain that was searched, for messages about missing names."""
    return f"ROS_DOMAIN_ID={os.environ.get('ROS_DOMAIN_ID') or 0}"
