"""Records the messages of selected topics as bytes: one thread receives them, another writes them.

The writing thread polls every 50 ms, so that receiving a message costs one append and wakes no
thread. If the disk is too slow for so long that the cache is full, messages are dropped and
counted. Without a cache the receiving thread writes each message itself, as in rosbag2. Messages
that arrive faster than the disk can write then wait in the subscription's queue.
"""

import threading
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo

from arm_cli.bag.topic_selection import TopicSelection
from arm_cli.bag_format.metadata import BagMetadata
from arm_cli.bag_format.offered_qos import OfferedQos
from arm_cli.bag_format.topic import BagMessage, BagTopic, TypeDefinition, find_definition
from arm_cli.bag_format.writer import BagWriter
from arm_cli.errors import BagError, NoSuchNameError
from arm_cli.interface_types import InterfaceIndex, load_class
from arm_cli.names import this_domain
from arm_cli.output import complain
from arm_cli.ros.graph import SETTLED_S, Graph
from arm_cli.ros.qos import RECORDING_DEPTH, offered_qos, recording_profile
from arm_cli.ros.session import NOTICE_AFTER_S, CommandSession
from arm_node.names import describe_known
from arm_node.polled_subscriptions import PolledSubscriptions

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
        """Start counting; at each gap the present number of publishers is asked for."""
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
        """Start the writing thread; the recording now owns the writer. 0 bytes mean no cache."""
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


TAKE_PERIOD_S = 0.01
SPIN_PERIOD_S = 0.1
"""How often to check for signals."""
ADAPT_PERIOD_S = 1.0
"""How often to check whether new publishers need a subscription with other QoS."""
DROPS_REPORT_PERIOD_S = 5.0


class BagRecorder:
    """Records the selected topics until a signal arrives; see `run`.

    Attributes:
        lost: the number of messages lost in transport, by topic; see `LossCounter`.
    """

    def __init__(
        self,
        session: CommandSession,
        recording: Recording,
        selection: TopicSelection,
        poll_period_s: float,
        use_sim_time: bool,
        overrides: Mapping[str, OfferedQos] | None = None,
    ) -> None:
        """Prepare; `overrides` has QoS of subscriptions that replaces that of the publishers.

        With `use_sim_time`, messages get the time of the session's clock.
        """
        self.lost: Counter[str] = Counter()
        self._session = session
        self._graph = Graph(session)
        self._recording = recording
        self._selection = selection
        self._poll_period_s = poll_period_s
        self._use_sim_time = use_sim_time
        self._overrides = overrides or {}
        self._polled = PolledSubscriptions(session.node)
        self._index = InterfaceIndex()
        self._subscriptions: dict[str, tuple[Subscription, QoSProfile, type]] = {}
        self._losses: dict[str, LossCounter] = {}
        self._skipped: set[str] = set()
        self._reported: set[str] = set()
        self._topics_at_report: frozenset[str] | None = None
        self._drops_reported = 0

    def run(self, discover: bool = True, ended: Callable[[], bool] = lambda: False) -> None:
        """Record until the recording fails or `ended`, asked between two messages, returns true.

        Without `discover`, topics that appear after the graph has settled are left out.

        Raises:
            StoppedError: a signal arrived.
        """
        started_s = time.monotonic()
        adapt_s = drops_s = started_s
        next_poll_s = next_spin_s = 0.0
        complain("Listening for topics...")
        if not discover:
            self._graph.settle()
            self._subscribe_new()
        while self._recording.failure is None and not ended():
            now_s = time.monotonic()
            if now_s >= next_poll_s:
                next_poll_s = now_s + self._poll_period_s
                if discover and not self._is_complete():
                    self._subscribe_new()
                # Suggestions for missing topics need a discovered graph.
                if now_s - started_s >= (NOTICE_AFTER_S if self._graph.topics() else SETTLED_S):
                    self._report_missing()
                if now_s - adapt_s >= ADAPT_PERIOD_S:
                    adapt_s = now_s
                    self._adapt()
                if now_s - drops_s >= DROPS_REPORT_PERIOD_S:
                    drops_s = now_s
                    self._report_drops()
            time.sleep(TAKE_PERIOD_S)
            if self._use_sim_time or now_s >= next_spin_s:
                next_spin_s = now_s + SPIN_PERIOD_S
                self._session.spin_once(0.0)
            self._take_all()

    def close(self) -> None:
        """End all subscriptions."""
        for subscription, *_ in self._subscriptions.values():
            self._session.node.destroy_subscription(subscription)
        self._subscriptions.clear()

    def _is_complete(self) -> bool:
        return self._selection.is_closed and self._selection.names <= self._subscriptions.keys()

    def _subscribe_new(self) -> None:
        before = len(self._subscriptions)
        for name, types in self._session.node.get_topic_names_and_types():
            known = name in self._subscriptions or name in self._skipped
            if not known and self._selection.wants(name) and self._graph.publishers(name):
                self._subscribe(name, types)
        if len(self._subscriptions) > before and self._is_complete():
            complain("All requested topics are subscribed. Stopping discovery...")

    def _subscribe(self, name: str, types: list[str]) -> None:
        if len(types) > 1:
            self._skip(name, f"it has several types: {', '.join(types)}")
            return
        try:
            message_class = load_class(self._index.find(types[0], ("msg",)))
        except NoSuchNameError as error:
            self._skip(name, str(error))
            return
        publishers = self._graph.publishers(name)
        hashes = [str(p.topic_type_hash) for p in publishers if p.topic_type_hash.version > 0]
        topic = BagTopic(
            name=name,
            type=types[0],
            type_hash=hashes[0] if hashes else "",
            offers=tuple(offered_qos(publisher) for publisher in publishers),
        )
        self._recording.add_topic(topic, find_definition(self._index, topic.type))
        self._open(name, message_class, self._profile(name, publishers))
        complain(f"Subscribed to topic '{name}'")

    def _open(self, name: str, message_class: type, profile: QoSProfile) -> None:
        subscription = self._polled.subscribe(message_class, name, profile)
        self._subscriptions[name] = (subscription, profile, message_class)
        self._losses[name] = LossCounter(lambda: len(self._graph.publishers(name)))

    def _profile(self, name: str, publishers: Sequence[TopicEndpointInfo]) -> QoSProfile:
        return recording_profile(publishers, self._overrides.get(name))

    def _take_all(self) -> None:
        put = self._recording.put
        for name, (subscription, _, _) in self._subscriptions.items():
            missing_before = self._losses[name].missing_before
            for data, info in self._polled.take(subscription, RECORDING_DEPTH):
                missing = missing_before(info["publication_sequence_number"])
                if missing:
                    self.lost[name] += missing
                if self._use_sim_time:
                    received_ns = published_ns = self._session.clock_ns()
                else:
                    received_ns = info["received_timestamp"] or time.time_ns()
                    published_ns = info["source_timestamp"] or received_ns
                put(BagMessage(name, received_ns, published_ns, data))

    def _skip(self, name: str, reason: str) -> None:
        self._skipped.add(name)
        complain(f"{name} is not recorded: {reason}")

    def _adapt(self) -> None:
        """Replace subscriptions whose QoS no longer fits the publishers."""
        for name, (subscription, profile, message_class) in list(self._subscriptions.items()):
            publishers = self._graph.publishers(name)
            if not publishers:
                continue
            wanted = self._profile(name, publishers)
            if (wanted.reliability, wanted.durability) != (profile.reliability, profile.durability):
                self._session.node.destroy_subscription(subscription)
                self._open(name, message_class, wanted)
                complain(f"Subscribed again to topic '{name}', whose publishers offer other QoS")

    def _report_missing(self) -> None:
        missing = sorted(self._selection.names - self._subscriptions.keys() - self._skipped)
        topics = frozenset(self._graph.topics())
        if topics == self._topics_at_report or not (missing or not self._subscriptions):
            return
        self._topics_at_report = topics
        if not missing:
            self._report_once(f"waiting for topics, {this_domain()}")
        for name in missing:
            # Reported again with a suggestion if a similar topic appears later.
            near = describe_known(name, topics)
            hint = f"; {near}" if near.startswith("did") else ""
            self._report_once(f"waiting for a publisher of {name} on {this_domain()}{hint}")

    def _report_once(self, text: str) -> None:
        if text not in self._reported:
            self._reported.add(text)
            complain(text)

    def _report_drops(self) -> None:
        dropped = self._recording.dropped.total() + self.lost.total()
        if dropped > self._drops_reported:
            complain(f"{dropped - self._drops_reported} messages were dropped ({dropped} in all)")
            self._drops_reported = dropped
