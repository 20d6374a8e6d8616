"""`arm topic find`: the topics of a type."""

import argparse

from arm_cli.listing import add_count_argument, add_hidden_argument, print_those_of
from arm_cli.word_completion import complete_with, message_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("topic_type", help="such as sensor_msgs/msg/Image"), message_names
    )
    add_count_argument(parser, "topics")
    add_hidden_argument(parser, "topics")


def run(options: argparse.Namespace) -> None:
    """Print the topics.

    Raises:
        NotFoundError: there is no such type.
    """
    print_those_of(options.topic_type, "msg", lambda graph: graph.topics(options.hidden), options)
