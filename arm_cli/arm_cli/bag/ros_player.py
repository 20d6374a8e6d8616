"""Publishes the messages of a bag at their times, read ahead in a thread."""

import queue
import threading
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rclpy.publisher import Publisher
from rclpy.time import Time
from rosgraph_msgs.msg import Clock

from arm_cli.bag_format.offered_qos import OfferedQos
from arm_cli.bag_format.topic import BagMessage, BagTopic, RecordedTopic
from arm_cli.errors import BagError, NoSuchNameError
from arm_cli.interface_types import InterfaceIndex, load_class
from arm_cli.output import complain
from arm_cli.ros.graph import Graph
from arm_cli.ros.qos import playing_profile
from arm_cli.ros.session import CommandSession

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
        """Prepare the thread, which alone uses the iterator, and reads so many messages ahead."""
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


SIGNAL_PERIOD_S = 0.05
"""The longest delay before a signal is noticed."""
MATCH_TIMEOUT_S = 1.0
AFTER_MATCH_S = 0.2
"""How long to wait after a match, because messages sent at that very moment may be lost."""
KEEP_ALIVE_S = 0.2
CLOCK_TOPIC = "/clock"
COMMON_TOPICS = frozenset(("/rosout", "/parameter_events"))
"""Topics that every node publishes."""


class _ClockTicker:
    """Publishes the bag's time on /clock.

    Attributes:
        next_s: the time of `time.monotonic` at which the next tick is due.
    """

    def __init__(self, session: CommandSession, rate_hz: float) -> None:
        """Create the publisher."""
        self.next_s = 0.0
        self._period_s = 1.0 / rate_hz
        self._publisher = session.node.create_publisher(Clock, CLOCK_TOPIC, 10)

    def tick(self, now_s: float, bag_time_ns: int) -> None:
        """Publish the bag's time."""
        self._publisher.publish(Clock(clock=Time(nanoseconds=bag_time_ns).to_msg()))
        self.next_s = max(self.next_s + self._period_s, now_s)


class BagPlayer:
    """Plays the messages of a bag."""

    def __init__(self, session: CommandSession, clock_rate_hz: float | None) -> None:
        """Prepare; without a rate, /clock is not published."""
        self._session = session
        self._publishers: dict[str, Publisher] = {}
        self._ticker = None if clock_rate_hz is None else _ClockTicker(session, clock_rate_hz)
        self._signals_seen_s = 0.0

    def advertise(
        self,
        topics: Sequence[RecordedTopic],
        names: Mapping[str, str],
        overrides: Mapping[str, OfferedQos] | None = None,
    ) -> list[str]:
        """Create the publishers, and wait until existing subscriptions have matched them.

        Topics that cannot be played are reported and left out. Other names and other QoS than
        recorded are by the names in the bag.

        Returns:
            The names of the topics that can be played.
        """
        index, node = InterfaceIndex(), self._session.node
        for recorded in topics:
            topic = recorded.topic
            name = names.get(topic.name, topic.name)
            if self._ticker is not None and name == CLOCK_TOPIC:
                complain(f"{name} of the bag is not played: --clock publishes it")
                continue
            reason = recorded.unreadable_reason(index)
            if reason is not None:
                complain(f"{topic.name} is not played: {reason}")
                continue
            try:
                message_class: Any = load_class(index.find(topic.type, ("msg",)))
            except NoSuchNameError as error:
                complain(f"{topic.name} is not played: {error}")
                continue
            override = (overrides or {}).get(topic.name)
            profile = playing_profile(topic.offers if override is None else [override])
            publisher = node.create_publisher(message_class, name, profile)
            if self._has_other_definition(topic, name):
                complain(f"{topic.name} is not played: the definition of {topic.type} has changed")
                node.destroy_publisher(publisher)
                continue
            self._publishers[topic.name] = publisher
        self._wait_for_matches()
        return list(self._publishers)

    def _wait_for_matches(self) -> None:
        graph = Graph(self._session)
        graph.settle()
        publishers = self._publishers.values()
        listeners = {p: len(graph.subscriptions(p.topic_name)) for p in publishers}
        self._session.wait_until(
            lambda: all(p.get_subscription_count() >= count for p, count in listeners.items()),
            timeout_s=MATCH_TIMEOUT_S,
        )
        if any(listeners.values()):
            self._session.spin_for(AFTER_MATCH_S)
        names = {publisher.topic_name for publisher in self._publishers.values()} - COMMON_TOPICS
        shared = sorted(name for name in names if graph.publishers(name))
        if shared:
            complain(f"other nodes also publish {', '.join(shared)}")

    def play(
        self,
        messages: Iterable[BagMessage],
        schedule: PlaySchedule,
        end_ns: int,
        *,
        to_the_end: bool,
    ) -> None:
        """Publish messages, in the order of their time, at their times, up to a time of the bag.

        With `to_the_end` it waits for that time after the last message.

        Raises:
            StoppedError: a signal arrived.
        """
        for message in messages:
            if message.log_time_ns > end_ns:
                break
            self._wait(schedule, message.log_time_ns)
            self._publishers[message.topic].publish(message.data)
        if to_the_end:
            self._wait(schedule, end_ns)

    def finish(self) -> None:
        """Wait until the last messages have arrived."""
        self._session.wait_for_delivery(self._publishers.values(), KEEP_ALIVE_S)

    def _wait(self, schedule: PlaySchedule, bag_time_ns: int) -> None:
        """Spin until a time of the bag, and publish /clock meanwhile."""
        due_s = schedule.due_s(bag_time_ns)
        while True:
            now_s = time.monotonic()
            if self._ticker is not None and now_s >= self._ticker.next_s:
                self._ticker.tick(now_s, schedule.bag_time_ns(now_s))
            if now_s >= due_s:
                break
            next_s = due_s if self._ticker is None else min(due_s, self._ticker.next_s)
            self._spin(min(max(next_s - now_s, 0.0), SIGNAL_PERIOD_S))
        if time.monotonic() - self._signals_seen_s >= SIGNAL_PERIOD_S:
            self._spin(0.0)

    def _spin(self, timeout_s: float) -> None:
        self._session.spin_once(timeout_s)
        self._signals_seen_s = time.monotonic()

    def _has_other_definition(self, topic: BagTopic, name: str) -> bool:
        node = self._session.node
        own = [
            str(info.topic_type_hash)
            for info in node.get_publishers_info_by_topic(name)
            if info.node_name == node.get_name() and info.topic_type_hash.version > 0
        ]
        return bool(topic.type_hash and own and topic.type_hash not in own)
