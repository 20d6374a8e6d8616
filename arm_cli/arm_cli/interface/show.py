"""`arm interface show`: the definition of a type."""

import argparse
import sys

from arm_cli.errors import UsageError
from arm_cli.interfaces.definition import Comments, describe_type
from arm_cli.interfaces.index import InterfaceIndex
from arm_cli.word_completion import complete_with, interface_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("type", help="such as std_msgs/msg/String; - reads it from stdin"),
        interface_names,
    )
    group = parser.add_mutually_exclusive_group()
    group.add_argument(
        "--all-comments", action="store_true", help="show the comments of nested types, too"
    )
    group.add_argument(
        "--no-comments", action="store_true", help="show neither comments nor empty lines"
    )


def run(options: argparse.Namespace) -> None:
    """Print the definition.

    Raises:
        NotFoundError: there is no such type.
        UsageError: stdin holds no name.
    """
    name = sys.stdin.readline().strip() if options.type == "-" else options.type
    if not name:
        raise UsageError("stdin holds no name of a type")
    index = InterfaceIndex()
    comments = Comments(outer=not options.no_comments, nested=options.all_comments)
    for line in describe_type(index, index.find(name), comments):
        print(line)
