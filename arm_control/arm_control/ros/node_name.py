"""Names of nodes."""

import re


def as_node_name(text: str) -> str:
    """Return a name for a node: letters, digits and underscores of ASCII, no digit first."""
    name = re.sub(r"\W", "_", text, flags=re.ASCII)
    return name if name.isidentifier() else f"_{name}"
