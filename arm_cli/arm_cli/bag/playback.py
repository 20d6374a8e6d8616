"""Computes when the messages of a bag are due, and reads them ahead in a thread."""

import queue
import threading
from collections.abc import Iterator
from dataclasses import dataclass

from arm_cli.bag.bag_topic import BagMessage
from arm_cli.errors import BagError

PUT_PERIOD_S = 0.1


@dataclass(frozen=True, slots=True)
class PlaySchedule:
    """Relates the bag's time to the player's clock.

    Attributes:
        bag_start_ns: the bag's time at which playing starts.
        started_s: the time of the player's clock at that moment.
        rate: seconds of bag time per second of the clock.
    """

    bag_start_ns: int
    started_s: float
    rate: float

    def due_s(self, bag_time_ns: int) -> float:
        """Return the clock's time at which a message is due."""
        return self.started_s + (bag_time_ns - self.bag_start_ns) * 1e-9 / self.rate

    def bag_time_ns(self, now_s: float) -> int:
        """Return the bag's time at a time of the clock."""
        return self.bag_start_ns + round((now_s - self.started_s) * self.rate * 1e9)


class ReadAhead:
    """Reads an iterator's messages ahead in a thread.

    Use it as a context manager, which stops the thread at its end.
    """

    def __init__(self, messages: Iterator[BagMessage], size: int) -> None:
        """Prepare the thread.

        Args:
            messages: the iterator, which only the thread uses.
            size: the number of messages to read ahead.
        """
        self._messages = messages
        self._queue: queue.Queue[BagMessage | BagError | None] = queue.Queue(size)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="bag_reader", daemon=True)

    def __enter__(self) -> "ReadAhead":
        """Start the thread."""
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop the thread."""
        self._ended.set()
        self._thread.join()

    def __iter__(self) -> Iterator[BagMessage]:
        """Yield the messages.

        Raises:
            BagError: the bag is damaged; the messages before the damage come first.
        """
        while True:
            item = self._queue.get()
            if item is None:
                return
            if isinstance(item, BagError):
                raise item
            yield item

    def _run(self) -> None:
        try:
            for message in self._messages:
                if not self._put(message):
                    return
            self._put(None)
        except BagError as error:
            self._put(error)

    def _put(self, item: BagMessage | BagError | None) -> bool:
        while not self._ended.is_set():
            try:
                self._queue.put(item, timeout=PUT_PERIOD_S)
            except queue.Full:
                continue
            return True
        return False
