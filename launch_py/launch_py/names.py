"""Names of the ROS graph."""


def join_names(namespace: str, name: str) -> str:
    """Return `name` resolved in `namespace`, with a leading slash; "" where both are empty."""
    if name.startswith("/"):
        return "/" + name.strip("/") if name.strip("/") else ""
    parts = [part for part in (namespace.strip("/"), name.strip("/")) if part]
    return "/" + "/".join(parts) if parts else ""
