"""`arm graph`: draws the nodes and topics."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from arm_cli.arguments import Argument, Flag, verb
from arm_cli.errors import CommandUsageError
from arm_cli.graph_files import to_dot, to_mermaid
from arm_cli.output import say_document, write_text
from arm_cli.ros.connection import settled_graph
from arm_node.drawing import NodeTopics, node_graph, to_svg

if TYPE_CHECKING:
    from arm_cli.ros.graph import Graph

WRITERS = {"svg": to_svg, "mermaid": to_mermaid, "dot": to_dot}
SUFFIXES = {".svg": "svg", ".mmd": "mermaid", ".md": "mermaid", ".dot": "dot", ".gv": "dot"}


@verb(
    Argument(
        "-f",
        "--format",
        choices=tuple(WRITERS),
        help="default: from the file's suffix (.svg, .mmd, .dot), or mermaid without a file",
    ),
    Argument("-o", "--output", metavar="FILE", help="default: print it"),
    Flag("-a", "--all", help="include hidden nodes and topics, /rosout and /parameter_events"),
)
def graph(options: argparse.Namespace) -> None:
    """Print or write the graph."""
    suffix = Path(options.output).suffix if options.output else ""
    if suffix and not options.format and suffix not in SUFFIXES:
        raise CommandUsageError(
            f"no format for {suffix!r} of {options.output}; there is {', '.join(SUFFIXES)}, or "
            f"--format {{{','.join(WRITERS)}}}"
        )
    write = WRITERS[options.format or SUFFIXES.get(suffix, "mermaid")]
    with settled_graph() as graph:
        text = write(node_graph(topics_by_node(graph), options.all))
    if options.output:
        write_text(Path(options.output), f"```mermaid\n{text}```\n" if suffix == ".md" else text)
    else:
        say_document(text, end="")


def topics_by_node(graph: "Graph") -> list[NodeTopics]:
    """Return all nodes, including hidden ones, with one entry for each name."""
    return [
        NodeTopics(
            node.full_name, tuple(graph.published_by(node)), tuple(graph.subscribed_by(node))
        )
        for node in dict.fromkeys(graph.nodes(hidden=True))
    ]
