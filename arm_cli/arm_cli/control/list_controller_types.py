"""`arm control list_controller_types`: the types of controllers that can be loaded."""

import argparse

from arm_cli.control.manager import add_manager_arguments, ask_manager
from arm_cli.output import add_json_argument, print_json

TYPE_WIDTH = 70


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_json_argument(parser)
    add_manager_arguments(parser)


def run(options: argparse.Namespace) -> None:
    """Print the types and their base classes.

    Raises:
        UnansweredError: the manager does not answer.
    """
    with ask_manager(options) as manager:
        types = manager.controller_types()
    if options.json:
        print_json([{"type": name, "base_class": base} for name, base in types])
        return
    for name, base in types:
        print(f"{name:<{TYPE_WIDTH}} {base}")
