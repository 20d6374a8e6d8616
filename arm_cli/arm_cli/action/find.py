"""`arm action find`: the actions of a type."""

import argparse

from arm_cli.listing import add_count_argument, print_those_of


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("action_type", help="such as control_msgs/action/GripperCommand")
    add_count_argument(parser, "actions")


def run(options: argparse.Namespace) -> None:
    """Print the actions.

    Raises:
        NotFoundError: there is no such type.
    """
    print_those_of(options.action_type, "action", lambda graph: graph.actions(), options)
