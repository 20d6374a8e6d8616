"""`arm topic list`: the topics."""

import argparse
from typing import TYPE_CHECKING

from arm_cli.listing import add_hidden_argument, add_list_arguments, print_list
from arm_cli.ros.connection import connect

if TYPE_CHECKING:
    from arm_cli.ros.graph import Graph


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_list_arguments(parser, "topics")
    add_hidden_argument(parser, "topics", "--all")
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="who publishes and who subscribes, by number"
    )


def run(options: argparse.Namespace) -> None:
    """Print the topics."""
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        topics = graph.topics(options.hidden)
        if options.verbose and not (options.json or options.count):
            _print_verbose(graph, topics)
        else:
            print_list(topics, options)


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
