"""`arm control list_*` and `view_controller_chains`: controllers and hardware, listed and drawn."""

import argparse
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from arm_cli.arguments import JSON, Flag, verb
from arm_cli.control.manager import (
    ACTIVE,
    MANAGER,
    OTHER,
    UNCONFIGURED,
    ask_manager,
    plain,
    state_colour,
)
from arm_cli.graph_files import write_picture
from arm_cli.output import colour, print_json, say, say_answer, say_coloured
from arm_node.drawing import Digraph, Edge, Shape, Vertex
from arm_node.printable import printable

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
"""Parts listed below a controller, by option: title, and a getter on the ControllerState."""

TYPE_WIDTH = 70
INACTIVE = 95
GOOD = 94
_COLOURS = {"active": ACTIVE, "inactive": INACTIVE, "unconfigured": UNCONFIGURED}


@verb(
    Flag("-v", "--verbose", help="show all of the following"),
    *(Flag(f"--{option.replace('_', '-')}", help=title) for option, (title, _) in _PARTS.items()),
    JSON,
    *MANAGER,
)
def list_controllers(options: argparse.Namespace) -> None:
    """Print the controllers, newest first."""
    with ask_manager(options) as manager:
        controllers = manager.controllers()
    if options.json:
        print_json(plain(controllers))
    elif not controllers:
        say("No controllers are currently loaded!")
    else:
        for line in _controller_lines(controllers, options):
            say_coloured(line)


def _controller_lines(controllers: list[Any], options: argparse.Namespace) -> Iterable[str]:
    name_width, type_width, state_width = (
        max(len(getattr(controller, column)) for controller in controllers)
        for column in ("name", "type", "state")
    )
    for controller in controllers:
        shade = state_colour(controller.state)
        name = colour(shade, f"{controller.name:<{name_width}}")
        state = colour(shade, f"{controller.state:<{state_width}}")
        yield f"{name} {printable(f'{controller.type:<{type_width}}')}  {state}"
        if options.verbose:
            yield f"\tupdate_rate: {controller.update_rate} Hz"
            yield f"\tis_async: {controller.is_async}"
        for option, (title, names) in _PARTS.items():
            if _is_wanted(option, options):
                yield f"\t{title}:"
                yield from (f"\t\t{printable(interface)}" for interface in names(controller))


def _is_wanted(part: str, options: argparse.Namespace) -> bool:
    # As in ros2 control, exported states are listed together with the references.
    with_references = part == "exported_interfaces" and options.reference_interfaces
    return options.verbose or with_references or getattr(options, part)


@verb(JSON, *MANAGER)
def list_controller_types(options: argparse.Namespace) -> None:
    """Print the types and their base classes."""
    with ask_manager(options) as manager:
        types = manager.controller_types()
    rows = [{"type": name, "base_class": base} for name, base in types]
    say_answer(options, rows, (f"{name:<{TYPE_WIDTH}} {base}" for name, base in types))


@verb(Flag("-v", "--verbose", help="also show state interfaces and data types"), JSON, *MANAGER)
def list_hardware_components(options: argparse.Namespace) -> None:
    """Print the components."""
    with ask_manager(options) as manager:
        components = manager.hardware_components()
    if options.json:
        print_json(plain(components))
        return
    for number, component in enumerate(components, start=1):
        say(f"Hardware Component {number}")
        for line in _component_lines(component, options.verbose):
            say_coloured(f"\t{line}")


def _component_lines(component: Any, verbose: bool) -> Iterator[str]:
    shade = _COLOURS.get(component.state.label, OTHER)
    yield f"name: {colour(shade, component.name)}"
    yield f"type: {printable(component.type)}"
    yield f"plugin name: {printable(component.plugin_name)}"
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
    data_type = f" [{printable(interface.data_type)}]" if verbose else ""
    return f"{printable(interface.name)}{data_type} {available(interface)}"


def available(interface: Any) -> str:
    """Return the mark that says whether an interface is available."""
    if interface.is_available:
        return colour(GOOD, "[available]")
    return colour(UNCONFIGURED, "[unavailable]")


def claimed(interface: Any) -> str:
    """Return the mark that says whether an interface is claimed."""
    return colour(GOOD, "[claimed]") if interface.is_claimed else "[unclaimed]"


@verb(JSON, *MANAGER)
def list_hardware_interfaces(options: argparse.Namespace) -> None:
    """Print the interfaces, sorted."""
    with ask_manager(options) as manager:
        interfaces = manager.hardware_interfaces()
    if options.json:
        from arm_node.messages.text import to_plain

        print_json(to_plain(interfaces))
        return
    say("command interfaces")
    for interface in sorted(interfaces.command_interfaces, key=lambda i: i.name):
        say_coloured(f"\t{printable(interface.name)} {available(interface)} {claimed(interface)}")
    say("state interfaces")
    for interface in sorted(interfaces.state_interfaces, key=lambda i: i.name):
        say(f"\t{interface.name}")


STEM = "controller_diagram"
STATES, COMMANDS = "state interfaces", "command interfaces"


@verb(Flag("--save", help="accepted; the picture is always saved"), *MANAGER)
def view_controller_chains(options: argparse.Namespace) -> None:
    """Write the picture and its graphviz source."""
    with ask_manager(options) as manager:
        controllers = manager.controllers()
    path = write_picture(controller_graph(controllers), Path(STEM))
    say(f"Saved controller diagram to {path.absolute()}")


def controller_graph(controllers: list[Any]) -> Digraph:
    """Return the graph: hardware states, controllers, hardware commands, from left to right.

    An interface that another controller exports links the two controllers.
    """
    exporters = {
        f"{controller.name}/{interface}": controller.name
        for controller in controllers
        for interface in (*controller.reference_interfaces, *controller.exported_state_interfaces)
    }
    vertices = [Vertex(STATES, f"hw {STATES}", Shape.BOX)]
    edges = []
    for controller in controllers:
        vertices.append(Vertex(controller.name, f"{controller.name}\n{controller.state}"))
        for source, names in _grouped(controller.required_state_interfaces, exporters, STATES):
            edges.append(Edge(source, controller.name, "\n".join(names)))
        for target, names in _grouped(controller.required_command_interfaces, exporters, COMMANDS):
            edges.append(Edge(controller.name, target, "\n".join(names)))
    vertices.append(Vertex(COMMANDS, f"hw {COMMANDS}", Shape.BOX))
    return Digraph(tuple(vertices), tuple(edges))


def _grouped(
    interfaces: list[str], exporters: dict[str, str], hardware: str
) -> list[tuple[str, list[str]]]:
    groups: dict[str, list[str]] = {}
    for interface in sorted(interfaces):
        groups.setdefault(exporters.get(interface, hardware), []).append(interface)
    return list(groups.items())
