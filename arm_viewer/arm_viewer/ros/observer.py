"""What everything has that looks at topics or services for the page."""

from collections.abc import Mapping, Sequence
from typing import Protocol

TopicTypes = Mapping[str, Sequence[str]]
"""The types of every topic that anybody knows, by name."""


class Observer(Protocol):
    """Watches one kind of thing; used by the executor's thread alone.

    What it has seen it offers as frozen data under a name of its own; the node puts these together
    to a snapshot.
    """

    def discover(self, topics: TopicTypes) -> None:
        """Look for what has come or gone; called once a second."""
        ...

    def collect(self, now_s: float) -> None:
        """Take what has arrived since the last time; called 30 times a second."""
        ...
