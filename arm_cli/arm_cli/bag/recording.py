"""A recording under way: messages come in on one thread and are written on another.

The writing thread looks every 50 ms what has come, so that taking a message in costs an append and
wakes nobody. When the disk is slower than the messages for so long that the cache is full, messages
are dropped and counted. Without a cache whoever puts a message in writes it, too, as in rosbag2:
what the disk is too slow for then waits in the subscription's queue.
"""

import threading
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

from arm_cli.bag.bag_metadata import BagMetadata
from arm_cli.bag.bag_topic import BagMessage, BagTopic
from arm_cli.bag.bag_writer import BagWriter
from arm_cli.bag.type_definition import TypeDefinition
from arm_cli.errors import BagError

LOOK_PERIOD_S = 0.05
FLUSH_PERIOD_S = 1.0
"""A recorder that is killed loses no more than this."""


@dataclass(frozen=True, slots=True)
class _NewTopic:
    topic: BagTopic
    definition: TypeDefinition


class Recording:
    """Records into a bag. Its methods are for one thread, which is not the writing one."""

    def __init__(self, writer: BagWriter, max_cache_bytes: int) -> None:
        """Start the writing thread.

        Args:
            writer: belongs to the recording from now on.
            max_cache_bytes: of messages that wait to be written; with 0 none waits.
        """
        self.dropped: Counter[str] = Counter()
        """Messages for which there was no room in the cache, by topic."""
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
        """What ended the writing before its time."""
        return self._failure

    def add_topic(self, topic: BagTopic, definition: TypeDefinition) -> None:
        """Announce a topic; before its first message, and only once."""
        with self._lock:
            self._waiting.append(_NewTopic(topic, definition))

    def put(self, message: BagMessage) -> None:
        """Take a message in, or drop and count it; without a cache, write it."""
        size, room = len(message.data), self._max_cache_bytes
        with self._lock:
            # A message that is larger than the whole cache has it to itself.
            if room and self._waiting_bytes and self._waiting_bytes + size > room:
                self.dropped[message.topic] += 1
                return
            self._waiting.append(message)
            self._waiting_bytes += size
        if not room:
            self._step(self._write_waiting)

    def finish(self) -> BagMetadata:
        """Write what waits, finish the bag, and return what it holds.

        Raises:
            BagError: it could not be written.
        """
        self._ending.set()
        self._thread.join()
        if self._failure is not None:
            raise self._failure
        return self._writer.metadata

    def _run(self) -> None:
        flushed_s = time.monotonic()
        while not self._ending.wait(LOOK_PERIOD_S):
            self._step(self._write_waiting)
            if time.monotonic() - flushed_s >= FLUSH_PERIOD_S:
                self._step(self._writer.flush)
                flushed_s = time.monotonic()
        self._step(self._write_waiting)
        self._step(self._writer.close)

    def _step(self, action: Callable[[], object]) -> None:
        """Do something with the writer, unless it has failed; an error ends the writing."""
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
