"""Names that nothing else has."""

from collections.abc import Collection


def free_name(name: str, taken: Collection[str]) -> str:
    """Return the name, or where it is taken the first of NAME_2, NAME_3 and so on that is not."""
    candidate, number = name, 1
    while candidate in taken:
        number += 1
        candidate = f"{name}_{number}"
    return candidate
