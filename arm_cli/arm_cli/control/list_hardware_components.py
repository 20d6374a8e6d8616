"""`arm control list_hardware_components`: the hardware and its interfaces."""

import argparse
from collections.abc import Iterator
from typing import Any

from arm_cli.control.manager import (
    ACTIVE,
    OTHER,
    UNCONFIGURED,
    add_manager_arguments,
    ask_manager,
    plain,
)
from arm_cli.output import add_json_argument, colour, print_json

INACTIVE = 95
GOOD = 94

_COLOURS = {"active": ACTIVE, "inactive": INACTIVE, "unconfigured": UNCONFIGURED}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="state interfaces and data types, too"
    )
    add_json_argument(parser)
    add_manager_arguments(parser)


def run(options: argparse.Namespace) -> None:
    """Print the components.

    Raises:
        UnansweredError: the manager does not answer.
    """
    with ask_manager(options) as manager:
        components = manager.hardware_components()
    if options.json:
        print_json(plain(components))
        return
    for number, component in enumerate(components, start=1):
        print(f"Hardware Component {number}")
        for line in _lines(component, options.verbose):
            print(f"\t{line}")


def _lines(component: Any, verbose: bool) -> Iterator[str]:
    shade = _COLOURS.get(component.state.label, OTHER)
    yield f"name: {colour(shade, component.name)}"
    yield f"type: {component.type}"
    yield f"plugin name: {component.plugin_name}"
    yield f"state: id={component.state.id} label={colour(shade, component.state.label)}"
    yield f"read/write rate: {component.rw_rate} Hz"
    yield f"is_async: {component.is_async}"
    yield "command interfaces"
    for interface in component.command_interfaces:
        yield f"\t{_describe(interface, verbose)} {claimed(interface)}"
    if verbose:
        yield "state interfaces"
        for interface in component.state_interfaces:
            yield f"\t{_describe(interface, verbose)}"


def _describe(interface: Any, verbose: bool) -> str:
    data_type = f" [{interface.data_type}]" if verbose else ""
    return f"{interface.name}{data_type} {available(interface)}"


def available(interface: Any) -> str:
    """Return the mark that says whether an interface is available."""
    if interface.is_available:
        return colour(GOOD, "[available]")
    return colour(UNCONFIGURED, "[unavailable]")


def claimed(interface: Any) -> str:
    """Return the mark that says whether an interface is claimed."""
    return colour(GOOD, "[claimed]") if interface.is_claimed else "[unclaimed]"
