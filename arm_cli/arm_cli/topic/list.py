"""`arm topic list`: the topics."""

import argparse
from typing import TYPE_CHECKING

from arm_cli.output import add_json_argument, print_json
from arm_cli.ros.connection import connect

if TYPE_CHECKING:
    from arm_cli.ros.graph import Graph


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("-t", "--show-types", action="store_true", help="with their types")
    parser.add_argument("-c", "--count-topics", action="store_true", help="only their number")
    parser.add_argument(
        "-a",
        "--all",
        "--include-hidden-topics",
        dest="hidden",
        action="store_true",
        help="hidden topics, too",
    )
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="who publishes and who subscribes, by number"
    )
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the topics."""
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        topics = graph.topics(options.hidden)
        if options.json:
            print_json([{"name": name, "types": types} for name, types in topics.items()])
        elif options.count_topics:
            print(len(topics))
        elif options.verbose:
            _print_verbose(graph, topics)
        else:
            for name, types in topics.items():
                print(f"{name} [{', '.join(types)}]" if options.show_types else name)


def _print_verbose(graph: "Graph", topics: dict[str, list[str]]) -> None:
    for title, noun, ask in (
        ("Published topics:", "publisher", graph.publishers),
        ("Subscribed topics:", "subscriber", graph.subscriptions),
    ):
        print(title)
        for name, types in topics.items():
            count = len(ask(name))
            if count:
                plural = "s" if count > 1 else ""
                print(f" * {name} [{', '.join(types)}] {count} {noun}{plural}")
        print()
