"""`arm action type`: an action's type."""

import argparse

from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.word_completion import complete_with


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("action_name", help="such as /gripper_action_controller/gripper_cmd"),
        completers.actions,
    )


def run(options: argparse.Namespace) -> None:
    """Print the type.

    Raises:
        NotFoundError: there is no such action.
    """
    with connect() as session:
        from arm_cli.ros.graph import Graph

        print(*Graph(session).find_action(options.action_name), sep="\n")
