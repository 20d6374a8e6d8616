"""Reads messages on a thread of its own, so that they are there when they are due."""

import queue
import threading
from collections.abc import Iterator

from arm_cli.bag.bag_topic import BagMessage
from arm_cli.errors import BagError

PUT_PERIOD_S = 0.1


class ReadAhead:
    """Hands on an iterator's messages, some of them read before they are asked for.

    Use it as a context manager; its end ends the thread.
    """

    def __init__(self, messages: Iterator[BagMessage], size: int) -> None:
        """Prepare.

        Args:
            messages: read by the thread only.
            size: how many are read ahead.
        """
        self._messages = messages
        self._queue: queue.Queue[BagMessage | BagError | None] = queue.Queue(size)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="bag_reader", daemon=True)

    def __enter__(self) -> "ReadAhead":
        """Start to read."""
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """End the thread."""
        self._ended.set()
        self._thread.join()

    def __iter__(self) -> Iterator[BagMessage]:
        """Yield the messages.

        Raises:
            BagError: the bag is damaged; after the messages before the damage.
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
