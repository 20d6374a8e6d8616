"""Says what the user may have meant when a name does not exist."""

from collections.abc import Iterable

MAX_LISTED = 15
"""More names than this are not listed in an error message: nobody would read them."""

NEAR = 0.7
"""How like a name must be to be meant, 1 for the same: 'grops' is 0.67 like 'ros2'."""


def describe_known(name: str, known: Iterable[str], noun: str = "there is") -> str:
    """Return the second half of an error about an unknown name.

    Args:
        name: what was asked for.
        known: what exists, in any order.
        noun: introduces the list, as in "the robot has".

    Returns:
        "did you mean 'a' or 'b'?" where something is near, else the list of what exists.
    """
    import difflib

    names = sorted(set(known))
    near = difflib.get_close_matches(name, names, n=3, cutoff=NEAR)
    near = near or [n for n in names if sorted(n) == sorted(name)][:3]
    near = near or [n for n in names if _holds(n, name) or _holds(name, n)][:3]
    if near:
        return f"did you mean {' or '.join(repr(n) for n in near)}?"
    if not names:
        return f"{noun} none"
    if len(names) > MAX_LISTED:
        return f"none of the {len(names)} is named like it"
    return f"{noun} {', '.join(names)}"


def _holds(name: str, part: str) -> bool:
    return len(part) > 2 and part in name
