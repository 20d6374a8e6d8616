"""Names of the ROS graph."""

import re

from launch_py.errors import LaunchFileError

# As ROS has them: no part begins with a digit, and nowhere are two underscores together.
FULL_NAME = re.compile(r"(?!.*__)(?:/[A-Za-z_]\w*)+", re.ASCII)


def join_names(namespace: str, name: str) -> str:
    """Return `name` resolved in `namespace`, with a leading slash; "" where both are empty."""
    if name.startswith("/"):
        return "/" + name.strip("/") if name.strip("/") else ""
    parts = [part for part in (namespace.strip("/"), name.strip("/")) if part]
    return "/" + "/".join(parts) if parts else ""


def graph_name(namespace: str, name: str) -> str:
    """Return the full name of a topic, service or action that is called `name` in `namespace`.

    Raises:
        LaunchFileError: ROS allows no such name.
    """
    full = join_names(namespace, name) if name else ""
    if not FULL_NAME.fullmatch(full):
        raise LaunchFileError(
            f"{name!r} is no name of a topic, service or action: it takes letters, digits and "
            "single underscores, in parts that are parted by slashes and begin with no digit"
        )
    return full
