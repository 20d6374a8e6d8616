"""Which nodes there are, and which topics each has."""

from collections.abc import Callable

from rclpy.node import Node, NodeNameNonExistentError

from arm_viewer.drawing.node_graph import NodeTopics
from arm_viewer.ros.observer import TopicTypes

NamesAndTypes = list[tuple[str, list[str]]]


class NodeObserver:
    """Keeps the nodes of others, sorted, one entry for each name."""

    def __init__(self, node: Node) -> None:
        """Start to look."""
        self._node = node
        self._own = node.get_fully_qualified_name()
        self.nodes: tuple[NodeTopics, ...] = ()

    def discover(self, topics: TopicTypes) -> None:
        """Look who is there."""
        names = sorted(set(self._node.get_node_names_and_namespaces()))
        nodes = tuple(self._look_at(name, namespace) for name, namespace in names)
        self.nodes = tuple(node for node in nodes if node.name != self._own)

    def collect(self, now_s: float) -> None:
        """Take notice of nothing: the graph is looked at once a second."""

    def _look_at(self, name: str, namespace: str) -> NodeTopics:
        def topics(ask: Callable[[str, str], NamesAndTypes]) -> tuple[str, ...]:
            try:
                return tuple(sorted(topic for topic, _ in ask(name, namespace)))
            except NodeNameNonExistentError:
                # It went away since it was listed.
                return ()

        return NodeTopics(
            f"{namespace.rstrip('/')}/{name}",
            topics(self._node.get_publisher_names_and_types_by_node),
            topics(self._node.get_subscriber_names_and_types_by_node),
        )
