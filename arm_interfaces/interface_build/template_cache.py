"""Let EmPy find the end of each template expression once instead of once per interface.

EmPy walks through a template character by character in Python, and does so anew for each file
that it makes; a third of the generation goes there. Where an expression ends depends on the text
and the position only, so that the answer can be kept.
"""

import functools
from collections.abc import Callable

import em

_SEARCHES = ("complex", "next")


@functools.cache
def install() -> None:
    """Keep the answers in this process; do nothing with an EmPy that works in another way."""
    if em.__version__.startswith("4."):
        for name in _SEARCHES:
            setattr(em.Scanner, name, _remembered(getattr(em.Scanner, name)))


def _remembered(search: Callable[..., int]) -> Callable[..., int]:
    """Wrap a search so that it runs once per text, position and arguments."""
    answers: dict[object, int] = {}

    @functools.wraps(search)
    def look_up(scanner: em.Scanner, *arguments: object, **options: object) -> int:
        position = scanner.head + scanner.pointer
        question = (scanner.buffer, position, arguments, *options.items())
        if question not in answers:
            answers[question] = search(scanner, *arguments, **options)
        return answers[question]

    return look_up
