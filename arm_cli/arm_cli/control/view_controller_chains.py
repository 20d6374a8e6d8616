"""`arm control view_controller_chains`: draws the controllers and their interfaces."""

import argparse
from pathlib import Path
from typing import Any

from arm_cli.arguments import Flag, verb
from arm_cli.control.manager import MANAGER, ask_manager
from arm_cli.graph_files import write_picture
from arm_cli.output import say
from arm_node.drawing.digraph import Digraph, Edge, Shape, Vertex

STEM = "controller_diagram"
STATES, COMMANDS = "state interfaces", "command interfaces"


@verb(
    Flag("--save", help="accepted; the picture is always saved"),
    *MANAGER,
)
def run(options: argparse.Namespace) -> None:
    """Write the picture and its graphviz source.

    Raises:
        UnansweredError: the manager does not answer.
        CommandUsageError: the file cannot be written.
    """
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
