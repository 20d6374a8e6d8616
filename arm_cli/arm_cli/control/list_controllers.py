"""`arm control list_controllers`: the loaded controllers, their types and states."""

import argparse
from collections.abc import Callable, Iterable
from typing import Any

from arm_cli.control.manager import add_manager_arguments, ask_manager, plain, state_colour
from arm_cli.output import add_json_argument, colour, print_json

_PARTS: dict[str, tuple[str, Callable[[Any], Iterable[str]]]] = {
    "claimed_interfaces": ("claimed interfaces", lambda c: c.claimed_interfaces),
    "required_command_interfaces": (
        "required command interfaces",
        lambda c: c.required_command_interfaces,
    ),
    "required_state_interfaces": (
        "required state interfaces",
        lambda c: c.required_state_interfaces,
    ),
    "chained_interfaces": (
        "chained to interfaces",
        lambda c: (name for chain in c.chain_connections for name in chain.reference_interfaces),
    ),
    "reference_interfaces": ("exported reference interfaces", lambda c: c.reference_interfaces),
    "exported_interfaces": ("exported state interfaces", lambda c: c.exported_state_interfaces),
}
"""What can be listed below a controller: option, title, and where it is in ControllerState."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("-v", "--verbose", action="store_true", help="all of the following")
    for option, (title, _) in _PARTS.items():
        parser.add_argument(f"--{option.replace('_', '-')}", action="store_true", help=title)
    add_json_argument(parser)
    add_manager_arguments(parser)


def run(options: argparse.Namespace) -> None:
    """Print the controllers, newest first.

    Raises:
        UnansweredError: the manager does not answer.
    """
    with ask_manager(options) as manager:
        controllers = manager.controllers()
    if options.json:
        print_json(plain(controllers))
    elif not controllers:
        print("No controllers are currently loaded!")
    else:
        for line in _lines(controllers, options):
            print(line)


def _lines(controllers: list[Any], options: argparse.Namespace) -> Iterable[str]:
    name_width, type_width, state_width = (
        max(len(getattr(controller, column)) for controller in controllers)
        for column in ("name", "type", "state")
    )
    for controller in controllers:
        shade = state_colour(controller.state)
        name = colour(shade, f"{controller.name:<{name_width}}")
        state = colour(shade, f"{controller.state:<{state_width}}")
        yield f"{name} {controller.type:<{type_width}}  {state}"
        if options.verbose:
            yield f"\tupdate_rate: {controller.update_rate} Hz"
            yield f"\tis_async: {controller.is_async}"
        for option, (title, names) in _PARTS.items():
            if options.verbose or getattr(options, option):
                yield f"\t{title}:"
                yield from (f"\t\t{interface}" for interface in names(controller))
