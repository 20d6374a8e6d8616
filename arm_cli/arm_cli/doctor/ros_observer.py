"""Observes a running simulation for a second, for the doctor."""

import math
from collections.abc import Iterable, Mapping
from typing import Any

from rclpy.parameter import parameter_value_to_python
from rclpy.qos import QoSCompatibility, qos_check_compatible
from rclpy.serialization import deserialize_message
from rclpy.topic_endpoint_info import TopicEndpointInfo
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, String

from arm_cli.doctor.observation import (
    ClockReading,
    ControlState,
    GraphObservation,
    LoadedController,
    Mismatch,
    ObservedHardware,
    SetpointTopic,
    StateTopic,
)
from arm_cli.errors import UnansweredError
from arm_cli.interface_types import InterfaceIndex, load_class
from arm_cli.ros.controller_manager import MARK, manager_client, manager_names
from arm_cli.ros.graph import Graph, NodeName
from arm_cli.ros.listeners import ClockListener
from arm_cli.ros.parameters import NodeParameters
from arm_cli.ros.qos import MEASURING
from arm_cli.ros.session import CommandSession
from arm_node.qos import LATCHED

COMMAND_TYPES = (
    "std_msgs/msg/Float64",
    "std_msgs/msg/Float64MultiArray",
    "trajectory_msgs/msg/JointTrajectory",
)
COMMAND_NAMES = ("command", "commands", "joint_trajectory", "reference")


def command_controllers(
    topics: Mapping[str, list[str]], managers: Iterable[ControlState]
) -> dict[str, LoadedController | None]:
    """Return the set-point topics, each with its controller, or None if that is not loaded.

    A controller's topics are below its own name, as in /position_controller/commands.
    """
    loaded = {
        f"{manager.manager.rpartition('/')[0]}/{controller.name}": controller
        for manager in managers
        for controller in manager.controllers
    }
    return {
        name: loaded.get(name.rpartition("/")[0])
        for name, types in topics.items()
        if name.rpartition("/")[2] in COMMAND_NAMES
        and len(types) == 1
        and types[0] in COMMAND_TYPES
    }


class CommandListener:
    """Counts the messages of one topic, and compares the last one's stamp with the clock.

    Attributes:
        topic: the topic's absolute name.
    """

    def __init__(
        self,
        session: CommandSession,
        topic: str,
        type_name: str,
        controller: LoadedController | None,
        clock: ClockListener,
    ) -> None:
        """Subscribe with the session's node."""
        self.topic = topic
        self._controller = controller
        self._clock = clock
        self._received = 0
        self._ahead_s: float | None = None
        self._lasting_s = 0.0
        message_class = load_class(InterfaceIndex().find(type_name, ("msg",)))
        session.node.create_subscription(message_class, topic, self._take, MEASURING)

    def report(self, publishers: tuple[str, ...], listeners: tuple[str, ...]) -> SetpointTopic:
        """Return the observed topic with its publishers and subscribers."""
        return SetpointTopic(
            self.topic,
            publishers,
            listeners,
            controller=self._controller.name if self._controller else "",
            state=self._controller.state if self._controller else "",
            received=self._received,
            ahead_s=self._ahead_s,
            lasting_s=self._lasting_s,
        )

    def _take(self, message: Any) -> None:
        self._received += 1
        header = getattr(message, "header", None)
        stamp_s = header.stamp.sec + header.stamp.nanosec * 1e-9 if header else 0.0
        # A stamp of 0 means "now".
        self._ahead_s = stamp_s - self._clock.now_s if stamp_s and self._clock.has_begun else None
        times = [p.time_from_start for p in getattr(message, "points", ())]
        self._lasting_s = max((t.sec + t.nanosec * 1e-9 for t in times), default=0.0)


class JointStateListener:
    """Counts the joint states of one topic.

    Attributes:
        topic: the topic's absolute name.
        received: the number of messages received.
    """

    def __init__(self, session: CommandSession, topic: str) -> None:
        """Subscribe with the session's node."""
        self.topic = topic
        self.received = 0
        self._last = b""
        session.node.create_subscription(JointState, topic, self._take, MEASURING, raw=True)

    def not_numbers(self) -> tuple[str, ...]:
        """Return the NaN values of the last message, as interfaces such as 'j0/position'."""
        if not self.received:
            return ()
        message = deserialize_message(self._last, JointState)
        values = {
            "position": message.position,
            "velocity": message.velocity,
            "effort": message.effort,
        }
        return tuple(
            f"{joint}/{kind}"
            for kind, numbers in values.items()
            for joint, number in zip(message.name, numbers, strict=False)
            if math.isnan(number)
        )

    def _take(self, message: bytes) -> None:
        self.received += 1
        self._last = message


class DescriptionListener:
    """Waits for a robot description.

    Attributes:
        topic: the topic's absolute name.
        text: the description, empty until it arrives.
    """

    def __init__(self, session: CommandSession, topic: str) -> None:
        """Subscribe with transient_local durability, as late joiners do."""
        self.topic = topic
        self.text = ""
        session.node.create_subscription(String, topic, self._take, LATCHED)

    def _take(self, message: String) -> None:
        self.text = message.data


class StopListener:
    """Listens to whether an emergency stop is latched."""

    def __init__(self, session: CommandSession, topic: str) -> None:
        self.topic = topic
        self.is_heard = self.is_engaged = False

        def take(message: Bool) -> None:
            self.is_heard, self.is_engaged = True, message.data

        session.node.create_subscription(Bool, topic, take, LATCHED)


WINDOW_S = 1.0
"""How long to watch the clock and to wait for commands."""
FIRST_MESSAGE_S = 3.0
ANSWER_TIMEOUT_S = 5.0
"""A node that takes longer is considered stuck."""
CLOCK = "/clock"
DESCRIPTION, DESCRIPTION_TYPE = "robot_description", "std_msgs/msg/String"
STATES, STATES_TYPE = "joint_states", "sensor_msgs/msg/JointState"
FACTOR = "real_time_factor"
STOPPED = "/emergency_stop/active"


def observe(session: CommandSession) -> GraphObservation:
    """Discover the graph, query the managers and listen to the topics."""
    graph = Graph(session)
    graph.settle()
    managers = tuple(
        _ask(session, name)
        for name in manager_names(session)
        if graph.server_count(f"{name}{MARK}")
    )
    topics = graph.topics()
    clock = ClockListener(session)
    descriptions = [
        DescriptionListener(session, name)
        for name in _named(topics, DESCRIPTION, DESCRIPTION_TYPE)
        if graph.publishers(name)
    ]
    states = [JointStateListener(session, name) for name in _named(topics, STATES, STATES_TYPE)]
    commands = [
        CommandListener(session, name, topics[name][0], controller, clock)
        for name, controller in command_controllers(topics, managers).items()
    ]
    stops = [StopListener(session, name) for name in topics if name.endswith(STOPPED)]
    if CLOCK in topics and graph.publishers(CLOCK):
        session.wait_until(lambda: clock.has_begun, timeout_s=FIRST_MESSAGE_S)
    session.spin_for(WINDOW_S)
    session.wait_until(
        lambda: (
            all(d.text for d in descriptions)
            and all(s.received for s in states if graph.publishers(s.topic))
            and all(s.is_heard for s in stops)
        ),
        timeout_s=FIRST_MESSAGE_S,
    )
    return GraphObservation(
        managers=managers,
        publishers={name: _names(graph.publishers(name)) for name in topics},
        descriptions={d.topic: d.text for d in descriptions},
        clock=_reading(session, graph, clock),
        clock_readers=_names(graph.subscriptions(CLOCK)),
        joint_states=tuple(
            StateTopic(
                s.topic,
                _names(graph.publishers(s.topic)),
                _names(graph.subscriptions(s.topic)),
                s.received,
                s.not_numbers(),
            )
            for s in states
        ),
        mismatches=tuple(m for name in topics for m in _mismatches(graph, name)),
        commands=tuple(
            c.report(_names(graph.publishers(c.topic)), _names(graph.subscriptions(c.topic)))
            for c in commands
        ),
        stopped=tuple(s.topic for s in stops if s.is_engaged),
        nodes=tuple(node.full_name for node in graph.nodes(hidden=False)),
    )


def _named(topics: Mapping[str, list[str]], name: str, type_name: str) -> list[str]:
    """Return the topics with this name and type in any namespace."""
    return [
        topic
        for topic, types in topics.items()
        if topic.rpartition("/")[2] == name and types == [type_name]
    ]


def _ask(session: CommandSession, name: str) -> ControlState:
    client = manager_client(session, name, ANSWER_TIMEOUT_S)
    try:
        controllers, components = client.controllers(), client.hardware_components()
    except UnansweredError:
        return ControlState(name, answered=False)
    return ControlState(
        name,
        controllers=tuple(
            LoadedController(c.name, c.state, tuple(c.claimed_interfaces)) for c in controllers
        ),
        hardware=tuple(
            ObservedHardware(
                c.name,
                c.state.label,
                {i.name: i.is_claimed for i in c.command_interfaces},
                tuple(i.name for i in c.state_interfaces),
            )
            for c in components
        ),
    )


def _reading(session: CommandSession, graph: Graph, clock: ClockListener) -> ClockReading | None:
    if not clock.has_begun:
        return None
    return ClockReading(clock.simulated_s, clock.wall_s, _wanted_factor(session, graph))


def _wanted_factor(session: CommandSession, graph: Graph) -> float | None:
    """Return the clock publisher's requested real-time factor, None if unknown or ambiguous."""
    sources = graph.publishers(CLOCK)
    if len(sources) != 1:
        return None
    node = NodeName(sources[0].node_namespace, sources[0].node_name)
    if not graph.server_count(f"{node.full_name}/get_parameters"):
        return None
    try:
        values = NodeParameters(session, node, ANSWER_TIMEOUT_S).values([FACTOR])
    except UnansweredError:
        return None
    # A number without a fraction is an integer parameter.
    factor = parameter_value_to_python(values[0]) if values else None
    return float(factor) if isinstance(factor, int | float) else None


def _mismatches(graph: Graph, topic: str) -> list[Mismatch]:
    return [
        Mismatch(topic, _name(publisher), _name(subscription), reason)
        for publisher in graph.publishers(topic)
        for subscription in graph.subscriptions(topic)
        if (reason := _reason(publisher, subscription))
    ]


def _reason(publisher: TopicEndpointInfo, subscription: TopicEndpointInfo) -> str:
    if publisher.topic_type != subscription.topic_type:
        return f"{publisher.topic_type} is published, but {subscription.topic_type} is expected"
    verdict, reason = qos_check_compatible(publisher.qos_profile, subscription.qos_profile)
    if verdict != QoSCompatibility.ERROR:
        return ""
    return reason.removeprefix("ERROR: ").strip().rstrip(";")


def _names(infos: list[TopicEndpointInfo]) -> tuple[str, ...]:
    return tuple(map(_name, infos))


def _name(info: TopicEndpointInfo) -> str:
    return NodeName(info.node_namespace, info.node_name).full_name
