"""Suggests what the user may have meant when a name does not exist.

`arm_node.names` holds the same function: launch_py imports no arm_* package.
"""

import os
from collections.abc import Iterable

MAX_LISTED = 15
"""An error message lists at most this many names: nobody would read more."""

MIN_SIMILARITY = 0.7
"""The lowest similarity of a suggestion, where 1 means equal: 'grops' is 0.67 like 'ros2'."""


def describe_known(name: str, known: Iterable[str], noun: str = "there is") -> str:
    """Return the second half of an error about an unknown name.

    `noun` introduces the list, as in "the robot has".

    Returns:
        "did you mean 'a' or 'b'?" if a name is similar, else the list of names that exist.
    """
    names = sorted(set(known))
    near = near_names(name, names)
    if near:
        return did_you_mean(near)
    if not names:
        return f"{noun} none"
    if len(names) > MAX_LISTED:
        return f"none of the {len(names)} has a similar name"
    return f"{noun} {', '.join(names)}"


def near_names(name: str, known: Iterable[str]) -> list[str]:
    """Return at most three of the known names, those that are similar to a name."""
    import difflib

    names = sorted(set(known))
    near = difflib.get_close_matches(name, names, n=3, cutoff=MIN_SIMILARITY)
    near = near or [n for n in names if sorted(n) == sorted(name)][:3]
    return near or [n for n in names if _holds(n, name) or _holds(name, n)][:3]


def did_you_mean(names: Iterable[str]) -> str:
    """Return the question whether the user meant one of these names."""
    return f"did you mean {' or '.join(map(repr, names))}?"


def describe_missing_file(
    what: str, path: str | os.PathLike[str], siblings: Iterable[str], noun: str
) -> str:
    """Return the error about a path that is not a regular file.

    `what` says what the file would be, such as "launch file". `siblings` are the files that exist
    where it was searched; `noun` introduces them.
    """
    if os.path.exists(path):
        return describe_irregular_file(what, path)
    return f"no {what} {path}; {describe_known(os.path.basename(path), siblings, noun)}"


def describe_irregular_file(what: str, path: str | os.PathLike[str]) -> str:
    """Return the error about a path that exists but is not a regular file."""
    return f"{path} is not a regular file, so it is not a {what}"


def _holds(name: str, part: str) -> bool:
    return len(part) > 2 and part in name
