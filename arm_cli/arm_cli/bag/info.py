"""`arm bag info`: what is in a bag."""

import argparse
import sys

from arm_cli.bag.bag_path import existing_path
from arm_cli.output import add_json_argument, print_json

SORTINGS = ("name", "type", "count")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("bag_path", type=existing_path, help="folder of a bag, or an .mcap file")
    parser.add_argument("-s", "--storage", choices=("mcap",), default="mcap", help="its format")
    parser.add_argument("-t", "--topic-name", action="store_true", help="only names of topics")
    parser.add_argument(
        "--sort", choices=SORTINGS, default="name", help="order of the topics (default name)"
    )
    # It is about services, of which a bag has none; but lines written for ros2 have it.
    parser.add_argument("-v", "--verbose", action="store_true", help=argparse.SUPPRESS)
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print it.

    Raises:
        BagError: the bag cannot be read.
    """
    from arm_cli.bag.bag_reader import BagReader, describe_unfinished
    from arm_cli.bag.info_text import bag_to_plain, describe_bag

    with BagReader(options.bag_path) as reader:
        unfinished = describe_unfinished(reader)
        if unfinished is not None:
            print(f"arm bag info: {unfinished}", file=sys.stderr)
        if options.json:
            print_json(bag_to_plain(reader))
        elif options.topic_name:
            print("\n".join(topic.name for topic in reader.topics))
        else:
            print(describe_bag(reader, options.sort))
