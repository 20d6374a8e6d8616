"""`arm graph`: nodes and topics as a picture."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from arm_cli.drawing.digraph import Digraph, Edge, Shape, Vertex
from arm_cli.drawing.dot import to_dot
from arm_cli.drawing.mermaid import to_mermaid
from arm_cli.drawing.picture_file import write_text
from arm_cli.drawing.svg import to_svg
from arm_cli.names import is_hidden
from arm_cli.ros.connection import connect

if TYPE_CHECKING:
    from arm_cli.ros.graph import Graph, Types

WRITERS = {"svg": to_svg, "mermaid": to_mermaid, "dot": to_dot}
SUFFIXES = {".svg": "svg", ".mmd": "mermaid", ".md": "mermaid", ".dot": "dot", ".gv": "dot"}
EVERYWHERE = ("/rosout", "/parameter_events")
"""Topics of nearly every node, which would be most of the picture."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument(
        "-f",
        "--format",
        choices=tuple(WRITERS),
        help="default: by the file's suffix (.svg, .mmd, .dot), mermaid without a file",
    )
    parser.add_argument("-o", "--output", metavar="FILE", help="default: print it")
    parser.add_argument(
        "-a",
        "--all",
        action="store_true",
        help="also hidden nodes and topics, /rosout and /parameter_events",
    )


def run(options: argparse.Namespace) -> None:
    """Print or write the graph.

    Raises:
        UsageError: the file cannot be written.
    """
    suffix = Path(options.output).suffix if options.output else ""
    write = WRITERS[options.format or SUFFIXES.get(suffix, "mermaid")]
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        text = write(node_graph(graph, options.all))
    if options.output:
        write_text(Path(options.output), f"```mermaid\n{text}```\n" if suffix == ".md" else text)
    else:
        print(text, end="")


def node_graph(graph: "Graph", complete: bool) -> Digraph:
    """Return nodes as ellipses, topics as boxes, and arrows in the direction of the messages."""

    def shown(topics: "Types") -> list[str]:
        return [t for t in topics if complete or not (is_hidden(t) or t in EVERYWHERE)]

    vertices: dict[str, Vertex] = {}
    edges: list[Edge] = []
    for node in dict.fromkeys(graph.nodes(hidden=complete)):
        name = node.full_name
        vertices[f"node {name}"] = Vertex(f"node {name}", name)
        for topic in shown(graph.published_by(node)):
            edges.append(Edge(f"node {name}", f"topic {topic}"))
        for topic in shown(graph.subscribed_by(node)):
            edges.append(Edge(f"topic {topic}", f"node {name}"))
    for topic in sorted({key for e in edges for key in (e.source, e.target)} - vertices.keys()):
        vertices[topic] = Vertex(topic, topic.removeprefix("topic "), Shape.BOX)
    return Digraph(tuple(vertices.values()), tuple(edges))
