"""Subscribes to the selected topics as they appear, and records their messages as bytes."""

import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence

from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo

from arm_cli.bag.bag_topic import BagMessage, BagTopic, find_definition
from arm_cli.bag.offered_qos import OfferedQos
from arm_cli.bag.recording import LossCounter, Recording
from arm_cli.bag.ros_qos import RECORDING_DEPTH, offered_qos, recording_profile
from arm_cli.bag.topic_selection import TopicSelection
from arm_cli.errors import NoSuchNameError
from arm_cli.interfaces.index import InterfaceIndex, load_class
from arm_cli.names import this_domain
from arm_cli.output import complain
from arm_cli.ros.graph import SETTLED_S, Graph
from arm_cli.ros.session import NOTICE_AFTER_S, CommandSession
from arm_node.names import describe_known
from arm_node.polled_subscriptions import PolledSubscriptions

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
        """Prepare.

        Args:
            session: its node subscribes to the topics.
            recording: receives the messages.
            selection: the topics to record.
            poll_period_s: how often to look for new topics.
            use_sim_time: whether messages get the time of the session's clock.
            overrides: QoS of subscriptions that replaces the publishers' QoS.
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
        """Record until the recording fails or `ended` returns true.

        Args:
            discover: whether to record topics that appear after the graph has settled.
            ended: returns whether to stop; called between two messages.

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
