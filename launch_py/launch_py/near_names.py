"""Says what the user may have meant when a name does not exist."""

from collections.abc import Iterable

MAX_LISTED = 15
"""More names than this are not listed in an error message: nobody would read them."""


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
    near = difflib.get_close_matches(name, names, n=3, cutoff=0.6)
    near = near or [n for n in names if len(name) > 2 and (name in n or n in name)][:3]
    if near:
        return f"did you mean {' or '.join(repr(n) for n in near)}?"
    if not names:
        return f"{noun} none"
    if len(names) > MAX_LISTED:
        return f"none of the {len(names)} is named like it"
    return f"{noun} {', '.join(names)}"
