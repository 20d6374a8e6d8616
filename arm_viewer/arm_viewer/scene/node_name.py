"""Names of things as names of nodes in the 3D view."""


def node_name(name: str) -> str:
    """Return a name that makes one node below its parent: a slash would make several."""
    return name.replace("/", "\N{DIVISION SLASH}")
