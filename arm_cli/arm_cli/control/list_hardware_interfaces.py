"""`arm control list_hardware_interfaces`: the command and state interfaces."""

import argparse

from arm_cli.control.list_hardware_components import available, claimed
from arm_cli.control.manager import add_manager_arguments, ask_manager
from arm_cli.output import add_json_argument, print_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_json_argument(parser)
    add_manager_arguments(parser)


def run(options: argparse.Namespace) -> None:
    """Print the interfaces, sorted.

    Raises:
        UnansweredError: the manager does not answer.
    """
    with ask_manager(options) as manager:
        interfaces = manager.hardware_interfaces()
    if options.json:
        from arm_cli.messages.text import to_plain

        print_json(to_plain(interfaces))
        return
    print("command interfaces")
    for interface in sorted(interfaces.command_interfaces, key=lambda i: i.name):
        print(f"\t{interface.name} {available(interface)} {claimed(interface)}")
    print("state interfaces")
    for interface in sorted(interfaces.state_interfaces, key=lambda i: i.name):
        print(f"\t{interface.name}")
