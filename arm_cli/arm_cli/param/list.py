"""`arm param list`: the parameters of a node, or of all."""

import argparse
import re
import sys

from arm_cli.errors import UnansweredError
from arm_cli.output import add_json_argument, print_json
from arm_cli.parameter_values import TYPE_NAMES
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.word_completion import complete_with


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("node_name", nargs="?", help="by default every node"),
        completers.nodes,
    )
    parser.add_argument(
        "--include-hidden-nodes", dest="hidden", action="store_true", help="hidden nodes, too"
    )
    parser.add_argument(
        "--param-prefixes", nargs="+", default=[], help="only parameters that begin so"
    )
    parser.add_argument(
        "--filter",
        type=_pattern,
        default=".*",
        metavar="REGEX",
        help="only parameters whose names begin as it says",
    )
    parser.add_argument("--param-type", action="store_true", help="with their types")
    add_json_argument(parser)


def _pattern(text: str) -> re.Pattern[str]:
    try:
        return re.compile(text)
    except re.error as error:
        raise argparse.ArgumentTypeError(f"{text!r} is no regular expression: {error}") from error


def run(options: argparse.Namespace) -> None:
    """Print the names of the parameters.

    Raises:
        NotFoundError: there is no such node.
        UnansweredError: the node that was named does not answer.
    """
    found: dict[str, dict[str, str]] = {}
    with connect() as session:
        from arm_cli.ros.graph import Graph
        from arm_cli.ros.parameters import NodeParameters

        graph = Graph(session)
        if options.node_name:
            nodes = [graph.find_node(options.node_name)]
        else:
            graph.settle()
            serving = graph.services()
            nodes = [
                node
                for node in graph.nodes(options.hidden)
                if f"{node.full_name}/list_parameters" in serving
            ]
        for node in nodes:
            parameters = NodeParameters(session, node)
            try:
                names = list(filter(options.filter.match, parameters.names(options.param_prefixes)))
                types = [d.type for d in parameters.descriptors(names)] if names else []
            except UnansweredError as error:
                if options.node_name:
                    raise
                print(f"arm param list: {error}", file=sys.stderr)
                continue
            found[node.full_name] = {n: TYPE_NAMES[t] for n, t in zip(names, types, strict=True)}
    if options.json:
        print_json(found)
        return
    for full_name, parameter_types in found.items():
        if not options.node_name:
            print(f"{full_name}:")
        for name, type_ in parameter_types.items():
            print(f"  {name} (type: {type_})" if options.param_type else f"  {name}")
