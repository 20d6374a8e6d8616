"""The ROS graph as this process has discovered it.

There is no daemon that knows the graph already, so every command discovers it in a few tenths of a
second. `settle` waits until a list can be complete: nothing new has appeared for a while, and every
endpoint has been attributed to a node, which its process announces in a separate message. A lookup
by name returns as soon as the name is discovered. Only a missing name waits, and for longer: a
wrong "there is no such node" is worse than a late one.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TypeVar

from rclpy.node import NodeNameNonExistentError
from rclpy.topic_endpoint_info import TopicEndpointInfo

from arm_cli.errors import CommandUsageError, NoSuchNameError, UnansweredError
from arm_cli.names import absolute_name, is_hidden, this_domain
from arm_cli.ros.session import CommandSession
from arm_node.names import describe_known

QUIET_S = 0.3
"""A graph without changes for this long is complete. Launched nodes announce every 0.25 s."""
EMPTY_S = 1.0
"""If no other node has been found for this long, there is none."""
MISSING_S = 2.0
"""A name is not reported as missing before this time."""
SETTLED_S = 3.0
"""A graph that keeps changing is used as it is after this time."""

_UNATTRIBUTED = "_NODE_NAME_UNKNOWN_"

Found = TypeVar("Found")

Types = dict[str, list[str]]
"""Types by name, sorted by name."""


@dataclass(frozen=True, slots=True, order=True)
class NodeName:
    """A node's namespace and name."""

    namespace: str
    name: str

    @classmethod
    def of(cls, name: str) -> "NodeName":
        """Return a node's name from the one that a user typed, such as '/arm/driver'."""
        namespace, _, base = absolute_name(name).rpartition("/")
        return cls(namespace or "/", base)

    @property
    def full_name(self) -> str:
        """The absolute name."""
        return f"{self.namespace.rstrip('/')}/{self.name}"


@dataclass(frozen=True, slots=True)
class GraphSurvey:
    """How much of the graph is known.

    Attributes:
        nodes: the number of other nodes.
        endpoints: the number of their publishers and subscriptions.
        services: the number of service servers.
        attributed: whether the node of every endpoint is known.
    """

    nodes: int
    endpoints: int
    services: int
    attributed: bool


@dataclass(frozen=True, slots=True)
class SettleTimes:
    """How long to wait for the graph to settle.

    Attributes:
        quiet_s: the graph is complete if nothing new has appeared for this long.
        empty_s: the graph is empty if no other node has been found for this long.
        settled_s: the longest wait.
    """

    quiet_s: float = QUIET_S
    empty_s: float = EMPTY_S
    settled_s: float = SETTLED_S


DEFAULT_TIMES = SettleTimes()


class Graph:
    """The graph as seen by a session's node."""

    def __init__(self, session: CommandSession) -> None:
        """View the graph from the session's node."""
        self._session = session
        self._node = session.node
        self._own = absolute_name(session.node.get_name())

    def settle(self, times: SettleTimes = DEFAULT_TIMES) -> None:
        """Wait until the graph is complete, as far as that can be known; a list is correct then."""
        settling = _Settling(self, self._session.started_s, times=times)
        self._session.wait_until(settling.done)

    def survey(self) -> "GraphSurvey":
        """Return how much of the graph is known now."""
        names = [name for name, _ in self._node.get_topic_names_and_types()]
        infos = [i for name in names for i in (*self.publishers(name), *self.subscriptions(name))]
        services = self._node.get_service_names_and_types()
        return GraphSurvey(
            nodes=len(self.nodes(hidden=True)),
            endpoints=len(infos),
            services=sum(self.server_count(name) for name, _ in services),
            attributed=not any(i.node_name == _UNATTRIBUTED for i in infos),
        )

    def nodes(self, hidden: bool = False) -> list[NodeName]:
        """Return all nodes except this command's own, sorted, with duplicates of a name."""
        names = [
            NodeName(namespace, name)
            for name, namespace in self._node.get_node_names_and_namespaces()
        ]
        return sorted(
            node
            for node in names
            if node.full_name != self._own and (hidden or not is_hidden(node.full_name))
        )

    def topics(self, hidden: bool = False) -> Types:
        """Return the topics of other nodes, with their types."""
        found = _sorted(self._node.get_topic_names_and_types(), hidden)
        return {
            name: types
            for name, types in found.items()
            if self.publishers(name) or self.subscriptions(name)
        }

    def services(self, hidden: bool = False) -> Types:
        """Return the services with a server or a client, with their types."""
        return _sorted(self._node.get_service_names_and_types(), hidden)

    def actions(self) -> Types:
        """Return the actions with their types."""
        # Imported late, here and below: rclpy.action takes 0.1 s, and few commands need it.
        from rclpy.action.graph import get_action_names_and_types

        return _sorted(get_action_names_and_types(self._node), hidden=True)

    def publishers(self, topic: str) -> list[TopicEndpointInfo]:
        """Return the other nodes' publishers of a topic."""
        return self._others(self._node.get_publishers_info_by_topic(topic))

    def subscriptions(self, topic: str) -> list[TopicEndpointInfo]:
        """Return the other nodes' subscriptions to a topic."""
        return self._others(self._node.get_subscriptions_info_by_topic(topic))

    def client_count(self, service: str) -> int:
        """Return the number of a service's clients."""
        return self._node.count_clients(service)

    def server_count(self, service: str) -> int:
        """Return the number of a service's servers."""
        return self._node.count_services(service)

    def published_by(self, node: NodeName) -> Types:
        """Return the topics that a node publishes."""
        return self._by_node(self._node.get_publisher_names_and_types_by_node, node)

    def subscribed_by(self, node: NodeName) -> Types:
        """Return the topics that a node subscribes to."""
        return self._by_node(self._node.get_subscriber_names_and_types_by_node, node)

    def served_by(self, node: NodeName) -> Types:
        """Return the services that a node offers."""
        return self._by_node(self._node.get_service_names_and_types_by_node, node)

    def called_by(self, node: NodeName) -> Types:
        """Return the services that a node has clients of."""
        return self._by_node(self._node.get_client_names_and_types_by_node, node)

    def action_servers_of(self, node: NodeName) -> Types:
        """Return the actions that a node serves."""
        from rclpy.action.graph import get_action_server_names_and_types_by_node

        return self._by_node(partial(get_action_server_names_and_types_by_node, self._node), node)

    def action_clients_of(self, node: NodeName) -> Types:
        """Return the actions that a node has clients of."""
        from rclpy.action.graph import get_action_client_names_and_types_by_node

        return self._by_node(partial(get_action_client_names_and_types_by_node, self._node), node)

    def find_topic(self, name: str) -> list[str]:
        """Return the types of a topic as soon as it is discovered.

        Raises:
            NoSuchNameError: there is no such topic; the message suggests similar names.
        """
        return self._find("topic", name, lambda: self.topics(hidden=True))

    def find_publishers(self, topic: str) -> list[TopicEndpointInfo]:
        """Return a topic's publishers as soon as one is discovered, or an empty list."""
        settling = _Settling(self, self._session.started_s, MISSING_S)
        self._session.wait_until(lambda: bool(self.publishers(topic)) or settling.done())
        return self.publishers(topic)

    def find_service(self, name: str) -> list[str]:
        """Return the types of a service as soon as it is discovered.

        Raises:
            NoSuchNameError: there is no such service; the message suggests similar names.
        """
        return self._find("service", name, lambda: self.services(hidden=True))

    def find_action(self, name: str) -> list[str]:
        """Return the types of an action as soon as it is discovered.

        Raises:
            NoSuchNameError: there is no such action; the message suggests similar names.
        """
        return self._find("action", name, self.actions)

    def find_node(self, name: str) -> NodeName:
        """Return a node as soon as it is discovered.

        Raises:
            NoSuchNameError: there is no such node; the message suggests similar names.
        """
        full_name = absolute_name(name)

        def nodes() -> dict[str, NodeName]:
            return {node.full_name: node for node in self.nodes(hidden=True)}

        return self._find("node", full_name, nodes)

    def _find(self, what: str, name: str, found: Callable[[], dict[str, Found]]) -> Found:
        name = absolute_name(name)
        settling = _Settling(self, self._session.started_s, MISSING_S)
        self._session.wait_until(lambda: name in found() or settling.done())
        discovered = found()
        if name in discovered:
            return discovered[name]
        known = [other for other in discovered if not is_hidden(other)]
        raise NoSuchNameError(
            f"no {what} {name!r} on {this_domain()}; {describe_known(name, known)}"
        )

    def wait_for_server(
        self,
        what: str,
        name: str,
        type_name: str,
        is_ready: Callable[[], bool],
        timeout_s: float | None,
    ) -> None:
        """Wait until a "service" or an "action" has a server, for ever without a timeout.

        Raises:
            CommandUsageError: its servers have another type.
            UnansweredError: it has no server before the timeout.
        """
        is_action = what == "action"
        served_by = self.action_servers_of if is_action else self.served_by

        def ready() -> bool:
            found = (served_by(node).get(name, []) for node in self.nodes(hidden=True))
            offered = sorted({type_ for types in found for type_ in types})
            if offered and type_name not in offered:
                raise CommandUsageError(f"{name} is a {', '.join(offered)}, not a {type_name}")
            return is_ready()

        def notice() -> str:
            known = self.actions() if is_action else self.services()
            near = describe_known(name, [other for other in known if other != name])
            hint = f"; {near}" if near.startswith("did") else ""
            return f"waiting for {what} to become available... {name}{hint}"

        if not self._session.wait_until(ready, notice, timeout_s):
            raise UnansweredError(f"{what} {name} has no server (waited {timeout_s:g} s)")

    def _others(self, infos: list[TopicEndpointInfo]) -> list[TopicEndpointInfo]:
        own = self._own
        return [i for i in infos if NodeName(i.node_namespace, i.node_name).full_name != own]

    def _by_node(
        self, ask: Callable[[str, str], list[tuple[str, list[str]]]], node: NodeName
    ) -> Types:
        try:
            return _sorted(ask(node.name, node.namespace), hidden=True)
        except NodeNameNonExistentError:
            # The node has ended since it was listed.
            return {}


class _Settling:
    """Tells when the graph has settled."""

    def __init__(
        self,
        graph: Graph,
        started_s: float,
        least_s: float = 0.0,
        times: SettleTimes = DEFAULT_TIMES,
    ) -> None:
        self._times = times
        self._graph = graph
        self._least_s = least_s
        self._started_s = started_s
        self._seen: GraphSurvey | None = None
        self._changed_s = started_s

    def done(self) -> bool:
        now = time.monotonic()
        survey = self._graph.survey()
        if survey != self._seen:
            self._seen, self._changed_s = survey, now
        age_s = now - self._started_s
        quiet = survey.attributed and now - self._changed_s >= self._times.quiet_s
        least_s = max(self._least_s, 0.0 if survey.nodes else self._times.empty_s)
        return age_s >= self._times.settled_s or (quiet and age_s >= least_s)


def _sorted(found: list[tuple[str, list[str]]], hidden: bool) -> Types:
    return {name: types for name, types in sorted(found) if hidden or not is_hidden(name)}
