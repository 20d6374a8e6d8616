"""Subscribes to what is to be recorded, as it appears, and hands the messages on as bytes."""

import sys
import time
from collections import Counter
from collections.abc import Mapping, Sequence

from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo

from arm_cli.bag.bag_topic import BagMessage, BagTopic
from arm_cli.bag.offered_qos import OfferedQos
from arm_cli.bag.recording import Recording
from arm_cli.bag.topic_selection import TopicSelection
from arm_cli.bag.type_definition import find_definition
from arm_cli.bag.writer_numbers import WriterNumbers
from arm_cli.errors import NotFoundError
from arm_cli.interfaces.index import InterfaceIndex, load_class
from arm_cli.names import this_domain
from arm_cli.ros.bag_qos import RECORDING_DEPTH, offered_qos, recording_profile
from arm_cli.ros.graph import SETTLED_S, Graph
from arm_cli.ros.session import PATIENCE_S, Session
from arm_node.polled_subscriptions import PolledSubscriptions
from launch_py.near_names import describe_known

TAKE_PERIOD_S = 0.01
SPIN_PERIOD_S = 0.1
"""So often signals are looked for."""
ADAPT_PERIOD_S = 1.0
"""So often it is looked whether new publishers want another subscription."""
DROPS_SAID_PERIOD_S = 5.0


class BagRecorder:
    """Records the selected topics until a signal comes; see `run`.

    Attributes:
        lost: messages that were sent between others, but did not come, by topic.
    """

    def __init__(
        self,
        session: Session,
        recording: Recording,
        selection: TopicSelection,
        poll_period_s: float,
        use_sim_time: bool,
        overrides: Mapping[str, OfferedQos] | None = None,
    ) -> None:
        """Prepare.

        Args:
            session: whose node subscribes.
            recording: where the messages go.
            selection: what is recorded.
            poll_period_s: of looking for new topics.
            use_sim_time: whether messages get the time of the session's clock.
            overrides: quality of service of subscriptions, where not that of the publishers.
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
        self._numbers: dict[str, WriterNumbers] = {}
        self._skipped: set[str] = set()
        self._said: set[str] = set()
        self._topics_looked_at: frozenset[str] | None = None
        self._dropped_said = 0

    def run(self, discover: bool = True) -> None:
        """Record until the recording fails.

        Args:
            discover: whether topics are recorded that appear after the graph has come to rest.

        Raises:
            StoppedError: a signal ends it.
        """
        started_s = time.monotonic()
        adapt_s = drops_s = started_s
        next_poll_s = next_spin_s = 0.0
        _say("Listening for topics...")
        if not discover:
            self._graph.settle()
            self._subscribe_new()
        while self._recording.failure is None:
            now_s = time.monotonic()
            if now_s >= next_poll_s:
                next_poll_s = now_s + self._poll_period_s
                if discover and not self._is_complete():
                    self._subscribe_new()
                # Who has found nobody yet cannot say what there is instead.
                if now_s - started_s >= (PATIENCE_S if self._graph.topics() else SETTLED_S):
                    self._say_missing()
                if now_s - adapt_s >= ADAPT_PERIOD_S:
                    adapt_s = now_s
                    self._adapt()
                if now_s - drops_s >= DROPS_SAID_PERIOD_S:
                    drops_s = now_s
                    self._say_drops()
            time.sleep(TAKE_PERIOD_S)
            if self._use_sim_time or now_s >= next_spin_s:
                next_spin_s = now_s + SPIN_PERIOD_S
                self._session.spin_once(0.0)
            self._take_all()

    def _is_complete(self) -> bool:
        return self._selection.is_closed and self._selection.names <= self._subscriptions.keys()

    def _subscribe_new(self) -> None:
        before = len(self._subscriptions)
        for name, types in self._session.node.get_topic_names_and_types():
            known = name in self._subscriptions or name in self._skipped
            if not known and self._selection.wants(name) and self._graph.publishers(name):
                self._subscribe(name, types)
        if len(self._subscriptions) > before and self._is_complete():
            _say("All requested topics are subscribed. Stopping discovery...")

    def _subscribe(self, name: str, types: list[str]) -> None:
        if len(types) > 1:
            self._skip(name, f"it has several types: {', '.join(types)}")
            return
        try:
            message_class = load_class(self._index.find(types[0], ("msg",)))
        except NotFoundError as error:
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
        _say(f"Subscribed to topic '{name}'")

    def _open(self, name: str, message_class: type, profile: QoSProfile) -> None:
        subscription = self._polled.subscribe(message_class, name, profile)
        self._subscriptions[name] = (subscription, profile, message_class)
        self._numbers[name] = WriterNumbers(lambda: len(self._graph.publishers(name)))

    def _profile(self, name: str, publishers: Sequence[TopicEndpointInfo]) -> QoSProfile:
        return recording_profile(publishers, self._overrides.get(name))

    def _take_all(self) -> None:
        put = self._recording.put
        for name, (subscription, _, _) in self._subscriptions.items():
            missing_before = self._numbers[name].missing_before
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
        _say(f"{name} is not recorded: {reason}")

    def _adapt(self) -> None:
        """Subscribe anew where publishers have come that the old subscription does not suit."""
        for name, (subscription, profile, message_class) in list(self._subscriptions.items()):
            publishers = self._graph.publishers(name)
            if not publishers:
                continue
            wanted = self._profile(name, publishers)
            if (wanted.reliability, wanted.durability) != (profile.reliability, profile.durability):
                self._session.node.destroy_subscription(subscription)
                self._open(name, message_class, wanted)
                _say(f"Subscribed anew to topic '{name}', whose publishers offer another QoS")

    def _say_missing(self) -> None:
        missing = sorted(self._selection.names - self._subscriptions.keys() - self._skipped)
        topics = frozenset(self._graph.topics())
        if topics == self._topics_looked_at or not (missing or not self._subscriptions):
            return
        self._topics_looked_at = topics
        if not missing:
            self._say_once(f"waiting for topics, {this_domain()}")
        for name in missing:
            # Said anew with its hint where the topic that is meant is found late.
            near = describe_known(name, topics)
            hint = f"; {near}" if near.startswith("did") else ""
            self._say_once(f"waiting for a publisher of {name} on {this_domain()}{hint}")

    def _say_once(self, text: str) -> None:
        if text not in self._said:
            self._said.add(text)
            _say(text)

    def _say_drops(self) -> None:
        dropped = self._recording.dropped.total() + self.lost.total()
        if dropped > self._dropped_said:
            _say(f"{dropped - self._dropped_said} messages were dropped ({dropped} in all)")
            self._dropped_said = dropped


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
