"""Lists existing names, suggests similar ones, and makes valid node names.

`launch_py.near_names` does the same for launch_py, which does not import this package.
"""

import re
from collections.abc import Iterable

MAX_LISTED = 40
"""Maximum names in a message; the others are counted."""
MAX_OFFERED = 15
"""With more names than this, an error about an unknown one lists none of them."""
MIN_SIMILARITY = 0.7
"""Similarity from which a name is suggested, 1 for equal: 'grops' and 'ros2' have 0.67."""


def as_node_name(text: str) -> str:
    """Return a valid node name: ASCII letters, digits and underscores, no leading digit."""
    name = re.sub(r"\W", "_", text, flags=re.ASCII)
    return name if name.isidentifier() else f"_{name}"


def listing(names: Iterable[str]) -> str:
    """Return names separated by commas, shortening long lists; "nothing" for no names."""
    every = list(names)
    listed = ", ".join(every[:MAX_LISTED])
    if len(every) > MAX_LISTED:
        return f"{listed} and {len(every) - MAX_LISTED} more"
    return listed or "nothing"


def describe_known(name: str, known: Iterable[str], noun: str = "there is") -> str:
    """Return the second half of an error about an unknown name.

    `noun` introduces the list, as in "the robot has".

    Returns:
        "did you mean 'a' or 'b'?" if some are similar, else the list of existing names.
    """
    # Imported here, because only an error needs it.
    import difflib

    names = sorted(set(known))
    near = (
        difflib.get_close_matches(name, names, n=3, cutoff=MIN_SIMILARITY)
        or [each for each in names if sorted(each) == sorted(name)][:3]
        or [each for each in names if _contains(each, name) or _contains(name, each)][:3]
    )
    if near:
        return f"did you mean {' or '.join(map(repr, near))}?"
    if not names:
        return f"{noun} none"
    if len(names) > MAX_OFFERED:
        return f"none of the {len(names)} has a similar name"
    return f"{noun} {', '.join(names)}"


def _contains(name: str, part: str) -> bool:
    return len(part) > 2 and part in name
