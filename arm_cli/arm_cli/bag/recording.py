"""A running recording: one thread receives messages and another writes them.

The writing thread polls every 50 ms, so that receiving a message costs one append and wakes no
thread. If the disk is too slow for so long that the cache is full, messages are dropped and
counted. Without a cache the receiving thread writes each message itself, as in rosbag2. Messages
that arrive faster than the disk can write then wait in the subscription's queue.
"""

import threading
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

from arm_cli.bag.bag_metadata import BagMetadata
from arm_cli.bag.bag_topic import BagMessage, BagTopic, TypeDefinition
from arm_cli.bag.bag_writer import BagWriter
from arm_cli.errors import BagError

POLL_PERIOD_S = 0.05
FLUSH_PERIOD_S = 1.0
"""A recorder that is killed loses at most the messages of this time."""


class LossCounter:
    """Counts the lost messages of a topic by gaps in their sequence numbers.

    The sender of a message is unknown, so a number is attributed to the publisher that it fits
    best. The count is exact for one publisher, and for several whose numbers are far apart. If the
    numbers of several publishers overlap, it is an estimate. Messages before the first received
    one and after the last one are not counted.
    """

    def __init__(self, count_publishers: Callable[[], int]) -> None:
        """Start counting.

        Args:
            count_publishers: returns the present number of publishers; called at each gap.
        """
        self._count_publishers = count_publishers
        self._latest: list[int] = []

    def missing_before(self, number: int) -> int:
        """Take the sequence number of a message; return how many messages before it are lost."""
        latest = self._latest
        if number - 1 in latest:
            latest.remove(number - 1)
            latest.append(number)
            return 0
        before = [other for other in latest if other < number]
        if not before or len(latest) < self._count_publishers():
            # The first message of a publisher. A restarted publisher counts from 1 again.
            latest.append(number)
            return 0
        last = max(before)
        latest.remove(last)
        latest.append(number)
        return number - last - 1


@dataclass(frozen=True, slots=True)
class _NewTopic:
    topic: BagTopic
    definition: TypeDefinition


class Recording:
    """Records into a bag. Call its methods from one thread; it writes in a thread of its own."""

    def __init__(self, writer: BagWriter, max_cache_bytes: int) -> None:
        """Start the writing thread.

        Args:
            writer: the writer, which the recording now owns.
            max_cache_bytes: the size of the cache; 0 means no cache.
        """
        self.dropped: Counter[str] = Counter()
        """The number of messages dropped because the cache was full, by topic."""
        self._writer = writer
        self._writer_lock = threading.Lock()
        self._max_cache_bytes = max_cache_bytes
        self._lock = threading.Lock()
        self._waiting: list[BagMessage | _NewTopic] = []
        self._waiting_bytes = 0
        self._failure: BagError | None = None
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="bag_writer", daemon=True)
        self._thread.start()

    @property
    def failure(self) -> BagError | None:
        """The error that stopped the writing, if any."""
        return self._failure

    def add_topic(self, topic: BagTopic, definition: TypeDefinition) -> None:
        """Add a topic, once and before its first message."""
        with self._lock:
            self._waiting.append(_NewTopic(topic, definition))

    def put(self, message: BagMessage) -> None:
        """Add a message to the cache, or drop and count it; without a cache, write it."""
        size, capacity = len(message.data), self._max_cache_bytes
        with self._lock:
            # An empty cache accepts even a message that is larger than the cache.
            if capacity and self._waiting_bytes and self._waiting_bytes + size > capacity:
                self.dropped[message.topic] += 1
                return
            self._waiting.append(message)
            self._waiting_bytes += size
        if not capacity:
            self._step(self._write_waiting)

    def finish(self) -> BagMetadata:
        """Write the waiting messages, finish the bag and return its metadata.

        Raises:
            BagError: the bag could not be written.
        """
        self._ending.set()
        self._thread.join()
        if self._failure is not None:
            raise self._failure
        return self._writer.metadata

    def _run(self) -> None:
        flushed_s = time.monotonic()
        while not self._ending.wait(POLL_PERIOD_S):
            self._step(self._write_waiting)
            if time.monotonic() - flushed_s >= FLUSH_PERIOD_S:
                self._step(self._writer.flush)
                flushed_s = time.monotonic()
        self._step(self._write_waiting)
        self._step(self._writer.close)

    def _step(self, action: Callable[[], object]) -> None:
        """Run an action of the writer unless it has failed; an error stops the writing."""
        with self._writer_lock:
            if self._failure is not None:
                return
            try:
                action()
            except BagError as error:
                self._writer.abandon()
                self._failure = error

    def _write_waiting(self) -> None:
        with self._lock:
            items, self._waiting = self._waiting, []
        for item in items:
            if isinstance(item, _NewTopic):
                self._writer.add_topic(item.topic, item.definition)
                continue
            self._writer.write(item)
            with self._lock:
                self._waiting_bytes -= len(item.data)
