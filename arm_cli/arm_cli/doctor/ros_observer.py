"""Observes a running simulation for a second, for the doctor."""

from collections.abc import Mapping

from rclpy.parameter import parameter_value_to_python
from rclpy.qos import QoSCompatibility, qos_check_compatible
from rclpy.topic_endpoint_info import TopicEndpointInfo

from arm_cli.doctor.observation import (
    ClockReading,
    ControlState,
    GraphObservation,
    LoadedController,
    Mismatch,
    ObservedHardware,
    StateTopic,
)
from arm_cli.doctor.ros_listeners import (
    CommandListener,
    DescriptionListener,
    JointStateListener,
    StopListener,
    command_controllers,
)
from arm_cli.errors import UnansweredError
from arm_cli.ros.clock_listener import ClockListener
from arm_cli.ros.controller_manager import manager_client
from arm_cli.ros.graph import Graph, NodeName
from arm_cli.ros.parameters import NodeParameters
from arm_cli.ros.session import CommandSession

WINDOW_S = 1.0
"""How long to watch the clock and to wait for commands."""
FIRST_MESSAGE_S = 3.0
ANSWER_TIMEOUT_S = 5.0
"""A node that takes longer is considered stuck."""
LIST_CONTROLLERS = "/list_controllers"
LIST_TYPE = "controller_manager_msgs/srv/ListControllers"
CLOCK = "/clock"
DESCRIPTION, DESCRIPTION_TYPE = "robot_description", "std_msgs/msg/String"
STATES, STATES_TYPE = "joint_states", "sensor_msgs/msg/JointState"
FACTOR = "real_time_factor"
STOPPED = "/emergency_stop/active"


def observe(session: CommandSession) -> GraphObservation:
    """Discover the graph, query the managers and listen to the topics."""
    graph = Graph(session)
    graph.settle()
    managers = tuple(_ask(session, name) for name in _manager_names(graph))
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


def _manager_names(graph: Graph) -> list[str]:
    return [
        name.removesuffix(LIST_CONTROLLERS)
        for name, types in graph.services().items()
        if name.endswith(LIST_CONTROLLERS) and LIST_TYPE in types and graph.server_count(name)
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
