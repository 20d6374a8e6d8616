"""What ticks publish, sent in bursts where ticks follow each other without a pause.

Sending a message wakes the thread that receives it. For a small arm that made a tick half as long
again; further messages, while the thread is awake, take a third of the first one's time. A loop
that waits between its ticks sends at once; one as fast as possible is half as fast again for
sending a few together.
"""

from collections.abc import Callable

from arm_control.clock import Clock, MonotonicClock

MOST_TICKS = 5
"""The depth of a subscriber for sensor data: a longer burst would push its own beginning out."""
LONGEST_HELD_S = 0.0005


class Outbox:
    """Holds messages from a tick to the end of it, or of the fourth that follows at once.

    Nothing is held while a loop waits, pauses or serves calls, nor longer than half a millisecond
    and the tick that runs. Loop thread only.
    """

    def __init__(self, clock: Clock | None = None) -> None:
        """Make it empty.

        Args:
            clock: wall time; default the operating system's monotonic clock.
        """
        self._now_s = (clock or MonotonicClock()).now_s
        self._messages: list[tuple[Callable[[bytes], None], bytes]] = []
        self._ticks = 0
        self._sent_s = self._now_s()

    def put(self, send: Callable[[bytes], None], message: bytes) -> None:
        """Take a message in; messages go out in the order in which they came.

        Args:
            send: sends it. What it depends on must live until the loop serves its next call.
            message: serialised.
        """
        self._messages.append((send, message))

    def end_tick(self) -> None:
        """Send what there is, if it is time."""
        self._ticks += 1
        if self._ticks == MOST_TICKS or self._now_s() - self._sent_s > LONGEST_HELD_S:
            self.send()

    def send(self) -> None:
        """Send what there is.

        Raises:
            Exception: what sending raised; the messages from there on are dropped.
        """
        messages, self._messages = self._messages, []
        self._ticks = 0
        for send, message in messages:
            send(message)
        self._sent_s = self._now_s()
