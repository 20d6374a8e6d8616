"""The graph of nodes, topics, publishers and subscribers."""

from collections.abc import Iterable
from dataclasses import dataclass

from arm_node.drawing.digraph import Digraph, Edge, Shape, Vertex

UBIQUITOUS = ("/rosout", "/parameter_events")
"""Topics of nearly every node, which would clutter the picture."""


@dataclass(frozen=True, slots=True)
class NodeTopics:
    """A node and its topics, by their absolute names."""

    name: str
    publishes: tuple[str, ...]
    subscribes: tuple[str, ...]


def node_graph(nodes: Iterable[NodeTopics], complete: bool = False) -> Digraph:
    """Return nodes as ellipses, topics as boxes, and arrows in the direction of the messages.

    Args:
        nodes: the nodes, in drawing order.
        complete: whether to draw also hidden nodes and topics, /rosout and /parameter_events.
    """

    def shown(names: Iterable[str]) -> list[str]:
        return [name for name in names if complete or not _is_left_out(name)]

    vertices: dict[str, Vertex] = {}
    edges: list[Edge] = []
    for node in nodes:
        if shown([node.name]):
            key = f"node {node.name}"
            vertices[key] = Vertex(key, node.name)
            edges += [Edge(key, f"topic {topic}") for topic in shown(node.publishes)]
            edges += [Edge(f"topic {topic}", key) for topic in shown(node.subscribes)]
    for topic in sorted({key for e in edges for key in (e.source, e.target)} - vertices.keys()):
        vertices[topic] = Vertex(topic, topic.removeprefix("topic "), Shape.BOX)
    return Digraph(tuple(vertices.values()), tuple(edges))


def _is_left_out(name: str) -> bool:
    # As usual in ROS, a name with a part that begins with an underscore is hidden.
    return name in UBIQUITOUS or "/_" in name
