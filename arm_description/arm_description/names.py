"""Names listed in a message, so that a reader sees what he could have written."""

from collections.abc import Iterable

LISTED_AT_MOST = 40


def listing(names: Iterable[str]) -> str:
    """Return names parted by commas, the many cut short; "nothing" where there are none."""
    every = list(names)
    listed = ", ".join(every[:LISTED_AT_MOST])
    if len(every) > LISTED_AT_MOST:
        return f"{listed} and {len(every) - LISTED_AT_MOST} more"
    return listed or "nothing"
