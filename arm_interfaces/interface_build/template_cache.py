"""Make EmPy find the end of each template expression once instead of once per interface.

EmPy scans a template character by character in Python, and again for each file that it writes; this
takes a third of the generation. The end of an expression depends only on the text and the position,
so it can be cached.
"""

import functools
from collections.abc import Callable

import em

_SEARCHES = ("complex", "next")


@functools.cache
def install() -> None:
    """Cache the results in this process; do nothing for another version of EmPy."""
    if em.__version__.startswith("4."):
        for name in _SEARCHES:
            setattr(em.Scanner, name, _cached(getattr(em.Scanner, name)))


def _cached(search: Callable[..., int]) -> Callable[..., int]:
    """Wrap a search so that it runs once per text, position and arguments."""
    results: dict[object, int] = {}

    @functools.wraps(search)
    def look_up(scanner: em.Scanner, *arguments: object, **options: object) -> int:
        position = scanner.head + scanner.pointer
        key = (scanner.buffer, position, arguments, *options.items())
        if key not in results:
            results[key] = search(scanner, *arguments, **options)
        return results[key]

    return look_up
