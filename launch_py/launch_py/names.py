"""Names of the ROS graph."""

import re

from launch_py.errors import LaunchFileError

# ROS's rules: no part starts with a digit, and no name has two underscores in a row.
FULL_NAME = re.compile(r"(?!.*__)(?:/[A-Za-z_]\w*)+", re.ASCII)


def join_names(namespace: str, name: str) -> str:
    """Return `name` resolved in `namespace`, with a leading slash; "" if both are empty."""
    if name.startswith("/"):
        return "/" + name.strip("/") if name.strip("/") else ""
    parts = [part for part in (namespace.strip("/"), name.strip("/")) if part]
    return "/" + "/".join(parts) if parts else ""


def graph_name(namespace: str, name: str) -> str:
    """Return the full name of the topic, service or action `name` in `namespace`.

    Raises:
        LaunchFileError: ROS does not allow the name.
    """
    full = join_names(namespace, name) if name else ""
    if not FULL_NAME.fullmatch(full):
        raise LaunchFileError(
            f"{name!r} is not a valid name of a topic, service or action: use letters, digits "
            "and single underscores, and separate parts by slashes; a part begins with no digit"
        )
    return full
