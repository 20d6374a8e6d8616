"""`arm topic find`: the topics of a type."""

import argparse

from arm_cli.interfaces.index import InterfaceIndex
from arm_cli.ros.connection import connect
from arm_cli.word_completion import complete_with, message_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("topic_type", help="such as sensor_msgs/msg/Image"), message_names
    )
    parser.add_argument("-c", "--count-topics", action="store_true", help="only their number")
    parser.add_argument(
        "-a",
        "--include-hidden-topics",
        dest="hidden",
        action="store_true",
        help="hidden topics, too",
    )


def run(options: argparse.Namespace) -> None:
    """Print the topics.

    Raises:
        NotFoundError: there is no such type.
    """
    wanted = InterfaceIndex().find(options.topic_type, ("msg",)).full_name
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        names = [name for name, types in graph.topics(options.hidden).items() if wanted in types]
    if options.count_topics:
        print(len(names))
    else:
        print(*names, sep="\n", end="\n" if names else "")
