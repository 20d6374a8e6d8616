"""`arm interface proto`: a type as YAML to fill in."""

import argparse

from arm_cli.interfaces.index import InterfaceIndex, load_class
from arm_cli.word_completion import complete_with, interface_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("type", help="such as std_msgs/msg/String"),
        interface_names,
    )
    parser.add_argument("--no-quotes", action="store_true", help="no quotes around the whole")


def run(options: argparse.Namespace) -> None:
    """Print the type's fields with their default values: a service's request, an action's goal.

    Raises:
        NotFoundError: there is no such type.
    """
    type_ = InterfaceIndex().find(options.type)
    from arm_cli.messages.text import to_yaml

    class_ = load_class(type_)
    part = {"msg": class_, "srv": getattr(class_, "Request", None), "action": None}[type_.kind]
    text = to_yaml((part or class_.Goal)())
    print(text if options.no_quotes else f'"{text}"')
