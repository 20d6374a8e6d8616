"""Holds the loop back until its partners have answered the last tick."""

import logging
import math
from collections.abc import Callable, Sequence

from arm_control.loop.clock import Clock, MonotonicClock

NEVER_NS = -1
NS_PER_S = 1_000_000_000

logger = logging.getLogger("controller_manager")


class LockStep:
    """A gate before each tick: it opens when every partner has answered the time of the last one.

    A partner answers with a stamp: that time or a later one. A partner that has not been heard
    since the start, or since the loop gave up on it, may answer with any stamp; that is how it
    announces itself.

    `record_answer` may be called on any thread, one at a time, and so may `hold` and `release`;
    everything else is for the loop thread.

    Attributes:
        partners: names of the partners.
        failure: why the loop was paused; empty once the gate has opened again.
    """

    def __init__(
        self, partners: Sequence[str], timeout_s: float, clock: Clock | None = None
    ) -> None:
        """Wait for these partners from the first tick on.

        `timeout_s`, the longest wait for an answer in wall time, may be infinite.
        """
        self.partners = tuple(partners)
        self.failure = ""
        self._timeout_s = timeout_s
        self._now_s = (clock or MonotonicClock()).now_s
        self._answered_ns = dict.fromkeys(self.partners, NEVER_NS)
        self._sources: list[Callable[[], None]] = []
        self._tick_ns = 0
        self._closed_since_s = math.nan
        self._is_held = False

    def record_answer(self, partner: str, stamp_ns: int) -> bool:
        """Record an answer; return whether it opens the gate, so that the loop must be woken."""
        answered_ns = self._answered_ns[partner]
        if answered_ns == NEVER_NS:
            # It has answered no earlier tick, so its first answer counts for the present one.
            stamp_ns = max(stamp_ns, self._tick_ns)
        if stamp_ns <= answered_ns:
            return False
        self._answered_ns[partner] = stamp_ns
        return not self._missing()

    def hold(self) -> None:
        """Keep the gate closed: a client is told now of what the loop gets only afterwards."""
        self._is_held = True

    def release(self) -> None:
        """End `hold`, as the loop has got it; the loop must be woken."""
        self._is_held = False

    def set_timeout(self, timeout_s: float) -> None:
        """Wait this long for an answer from now on."""
        self._timeout_s = timeout_s

    def add_source(self, take: Callable[[], None]) -> None:
        """Call `take` before each tick, to receive what the partners sent before they answered."""
        self._sources.append(take)

    def begin_tick(self) -> None:
        """Receive what the partners have sent."""
        for take in self._sources:
            take()

    def end_tick(self, time_s: float) -> None:
        """Close the gate until the partners have answered this time."""
        tick_ns = round(time_s * NS_PER_S)
        if tick_ns < self._tick_ns:
            # The clock was set back: answers to the times before must not count for those to come.
            for partner, answered_ns in self._answered_ns.items():
                self._answered_ns[partner] = min(answered_ns, tick_ns - 1)
        self._tick_ns = tick_ns

    def is_open(self) -> bool:
        """Return whether every partner has answered."""
        if self._is_held or self._missing():
            return False
        self._closed_since_s = math.nan
        self.failure = ""
        return True

    def remaining_s(self) -> float:
        """Return the time left until the wait times out; 0 or less once it has."""
        now_s = self._now_s()
        if math.isnan(self._closed_since_s):
            self._closed_since_s = now_s
        return self._closed_since_s + self._timeout_s - now_s

    def pause_timeout(self) -> None:
        """Stop the time-out until the loop wants to tick again, for example during a pause."""
        self._closed_since_s = math.nan

    def give_up(self) -> None:
        """Stop waiting: record the silent partners, which must announce themselves again."""
        silent = self._missing()
        for partner in silent:
            self._answered_ns[partner] = NEVER_NS
        time_s = self._tick_ns / NS_PER_S
        self.failure = (
            f"lock-step: no answer from {', '.join(silent)} for the time {time_s:.3f} s within "
            f"{self._timeout_s:g} s; the simulation is paused"
        )
        logger.error("%s. Resume it with: arm sim play", self.failure)
        self.pause_timeout()

    def _missing(self) -> list[str]:
        tick_ns = self._tick_ns
        return [name for name, answered_ns in self._answered_ns.items() if answered_ns < tick_ns]
