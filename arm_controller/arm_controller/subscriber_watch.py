"""Decides when to publish a command that is sent only once.

A position controller subscribes with best effort. A message that is published right after the match
may be lost; 0.2 s later it arrives. While the controller is still starting, the message must not go
only to an echo or a recorder.
"""

from collections.abc import Collection
from enum import Enum

SETTLE_S = 0.2
"""How long after a match messages may still be lost."""

OTHERS_WAIT_S = 5.0
"""How long to wait for the expected subscriber before accepting another one."""


class Subscribers(Enum):
    """Who subscribes to the commands, the best last."""

    NONE = "none"
    OTHERS = "others"
    CONTROLLER = "controller"


class SubscriberWatch:
    """Records who subscribes and since when. Times are from any steady clock, in s.

    Args:
        controller: full name of the node that receives the commands.
        now_s: the current time.
    """

    def __init__(self, controller: str, now_s: float) -> None:
        self._controller = controller
        self._since_s = now_s
        self._subscribers = Subscribers.NONE
        self._names: frozenset[str] = frozenset()

    @property
    def subscribers(self) -> Subscribers:
        """The subscribers at the last `observe`."""
        return self._subscribers

    def observe(self, names: Collection[str], now_s: float) -> None:
        """Record the full names of the nodes that are now matched with the publisher."""
        self._names = frozenset(names)
        subscribers = self._kind_of(self._names)
        if subscribers is not self._subscribers:
            self._subscribers, self._since_s = subscribers, now_s

    def unchanged_s(self, now_s: float) -> float:
        """Return how long `subscribers` has been unchanged."""
        return now_s - self._since_s

    def is_ready(self, now_s: float) -> bool:
        """Return whether a command that is published now will arrive."""
        if self._subscribers is Subscribers.NONE:
            return False
        controlled = self._subscribers is Subscribers.CONTROLLER
        return self.unchanged_s(now_s) >= (SETTLE_S if controlled else OTHERS_WAIT_S)

    def describe(self) -> str:
        """Return a phrase that says who subscribes."""
        if self._subscribers is Subscribers.CONTROLLER:
            return f"{self._controller} listens"
        if self._subscribers is Subscribers.OTHERS:
            verb = "listens" if len(self._names) == 1 else "listen"
            return f"only {', '.join(sorted(self._names))} {verb}, not {self._controller}"
        return "nobody listens"

    def _kind_of(self, names: frozenset[str]) -> Subscribers:
        if self._controller in names:
            return Subscribers.CONTROLLER
        return Subscribers.OTHERS if names else Subscribers.NONE
