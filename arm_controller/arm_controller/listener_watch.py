"""When a command that is sent once may go out.

A position controller subscribes best effort: a message published at the instant of the match can
be lost, 0.2 s later it arrives. And somebody who merely looks on (an echo, a recorder) must not
use up the one message while the controller is still starting.
"""

from collections.abc import Collection
from enum import Enum

SETTLE_S = 0.2
"""After a match the middleware of the other side may still be busy with it."""

ONLOOKER_S = 5.0
"""So long others alone must listen before one of them may be the real addressee."""


class Audience(Enum):
    """Who subscribes to the commands."""

    NOBODY = "nobody"
    ONLOOKERS = "onlookers"
    CONTROLLER = "controller"


class ListenerWatch:
    """Keeps account of who listens and since when. Times are of any steady clock, in s.

    Args:
        controller: full name of the node to which the commands are addressed.
        now_s: the present time.
    """

    def __init__(self, controller: str, now_s: float) -> None:
        self._controller = controller
        self._since_s = now_s
        self._audience = Audience.NOBODY
        self._listeners: frozenset[str] = frozenset()

    @property
    def audience(self) -> Audience:
        """Who listened at the last `observe`."""
        return self._audience

    @property
    def listeners(self) -> frozenset[str]:
        """Full names of the nodes that listened at the last `observe`."""
        return self._listeners

    def observe(self, listeners: Collection[str], now_s: float) -> None:
        """Take note of the nodes that are matched with the publisher now."""
        self._listeners = frozenset(listeners)
        audience = self._audience_of(self._listeners)
        if audience is not self._audience:
            self._audience, self._since_s = audience, now_s

    def lasting_s(self, now_s: float) -> float:
        """Return for how long the audience has been as it is."""
        return now_s - self._since_s

    def is_ready(self, now_s: float) -> bool:
        """Return whether a command that is published now reaches its addressee."""
        if self._audience is Audience.NOBODY:
            return False
        controlled = self._audience is Audience.CONTROLLER
        return self.lasting_s(now_s) >= (SETTLE_S if controlled else ONLOOKER_S)

    def describe(self) -> str:
        """Return a sentence about who listens."""
        if self._audience is Audience.CONTROLLER:
            return f"{self._controller} listens"
        if self._audience is Audience.ONLOOKERS:
            return f"only {', '.join(sorted(self._listeners))} listens, not {self._controller}"
        return "nobody listens"

    def _audience_of(self, listeners: frozenset[str]) -> Audience:
        if self._controller in listeners:
            return Audience.CONTROLLER
        return Audience.ONLOOKERS if listeners else Audience.NOBODY
