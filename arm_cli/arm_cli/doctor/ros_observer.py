"""Observes a running simulation for a second, for the doctor."""

import math
from collections.abc import Iterable, Mapping
from typing import Any

from rclpy.parameter import parameter_value_to_python
from rclpy.qos import QoSCompatibility, QoSProfile, qos_check_compatible
from rclpy.serialization import deserialize_message
from rclpy.topic_endpoint_info import TopicEndpointInfo

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


class _Heard:
    """What one topic says while the doctor listens.

    Attributes:
        topic: the topic's absolute name.
        received: the number of messages received.
        clock_s: the simulation time at the last one's arrival; None if it was not known.
    """

    def __init__(
        self,
        session: CommandSession,
        clock: ClockListener,
        topic: str,
        type_name: str,
        profile: QoSProfile = MEASURING,
    ) -> None:
        self.topic = topic
        self.received = 0
        self.clock_s: float | None = None
        self._clock = clock
        self._last = b""
        self._class = load_class(InterfaceIndex().find(type_name, ("msg",)))
        # Only the last message is read: a fast topic would take all the time.
        session.node.create_subscription(self._class, topic, self._take, profile, raw=True)

    def last(self) -> Any:
        """Return the last message; None before the first."""
        return deserialize_message(self._last, self._class) if self.received else None

    def _take(self, data: bytes) -> None:
        self.received, self._last = self.received + 1, data
        self.clock_s = self._clock.now_s if self._clock.has_begun else None


WINDOW_S = 1.0
"""How long to watch the clock and to wait for commands."""
FIRST_MESSAGE_S = 3.0
ANSWER_TIMEOUT_S = 5.0
"""A node that takes longer is considered stuck."""
CLOCK = "/clock"
DESCRIPTION, DESCRIPTION_TYPE = "robot_description", "std_msgs/msg/String"
STATES, STATES_TYPE = "joint_states", "sensor_msgs/msg/JointState"
FACTOR = "real_time_factor"
STOPPED, STOPPED_TYPE = "/emergency_stop/active", "std_msgs/msg/Bool"


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
        _Heard(session, clock, name, DESCRIPTION_TYPE, LATCHED)
        for name in _named(topics, DESCRIPTION, DESCRIPTION_TYPE)
        if graph.publishers(name)
    ]
    states = [
        _Heard(session, clock, name, STATES_TYPE) for name in _named(topics, STATES, STATES_TYPE)
    ]
    commands = [
        (_Heard(session, clock, name, topics[name][0]), controller)
        for name, controller in command_controllers(topics, managers).items()
    ]
    stops = [
        _Heard(session, clock, name, STOPPED_TYPE, LATCHED)
        for name in topics
        if name.endswith(STOPPED)
    ]
    if CLOCK in topics and graph.publishers(CLOCK):
        session.wait_until(lambda: clock.has_begun, timeout_s=FIRST_MESSAGE_S)
    session.spin_for(WINDOW_S)
    session.wait_until(
        lambda: (
            all(map(_text, descriptions))
            and all(s.received for s in states if graph.publishers(s.topic))
            and all(s.received for s in stops)
        ),
        timeout_s=FIRST_MESSAGE_S,
    )
    return GraphObservation(
        managers=managers,
        publishers={name: _names(graph.publishers(name)) for name in topics},
        descriptions={d.topic: _text(d) for d in descriptions},
        clock=_reading(session, graph, clock),
        clock_readers=_names(graph.subscriptions(CLOCK)),
        joint_states=tuple(
            StateTopic(
                s.topic,
                _names(graph.publishers(s.topic)),
                _names(graph.subscriptions(s.topic)),
                s.received,
                _not_numbers(s),
            )
            for s in states
        ),
        mismatches=tuple(m for name in topics for m in _mismatches(graph, name)),
        commands=tuple(_setpoints(graph, heard, controller) for heard, controller in commands),
        stopped=tuple(s.topic for s in stops if s.received and s.last().data),
        nodes=tuple(node.full_name for node in graph.nodes(hidden=False)),
    )


def _named(topics: Mapping[str, list[str]], name: str, type_name: str) -> list[str]:
    """Return the topics with this name and type in any namespace."""
    return [
        topic
        for topic, types in topics.items()
        if topic.rpartition("/")[2] == name and types == [type_name]
    ]


def _text(description: _Heard) -> str:
    """Return a robot description, empty until it arrives."""
    return description.last().data if description.received else ""


def _not_numbers(states: _Heard) -> tuple[str, ...]:
    """Return the NaN values of the last joint states, as interfaces such as 'j0/position'."""
    message = states.last()
    if message is None:
        return ()
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


def _setpoints(graph: Graph, heard: _Heard, controller: LoadedController | None) -> SetpointTopic:
    message = heard.last()
    header = getattr(message, "header", None)
    # A stamp of 0 means "now".
    stamp_s = header.stamp.sec + header.stamp.nanosec * 1e-9 if header else 0.0
    times = [point.time_from_start for point in getattr(message, "points", ())]
    return SetpointTopic(
        heard.topic,
        _names(graph.publishers(heard.topic)),
        _names(graph.subscriptions(heard.topic)),
        controller=controller.name if controller else "",
        state=controller.state if controller else "",
        received=heard.received,
        ahead_s=stamp_s - heard.clock_s if stamp_s and heard.clock_s is not None else None,
        lasting_s=max((time.sec + time.nanosec * 1e-9 for time in times), default=0.0),
    )


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
