"""Makes the manual's drawings as files, so that the manual needs no script to show them."""

from pathlib import Path

from arm_node.drawing import Digraph, Edge, Shape, Vertex, to_svg

IMAGES = Path(__file__).with_name("images")

COMMAND = Digraph(
    (
        Vertex("user", "your node"),
        Vertex("executor", "executor thread", Shape.BOX),
        Vertex("controllers", "control loop:\ncontrollers that command", Shape.BOX),
        Vertex("physics", "control loop:\nhardware and physics", Shape.BOX),
        Vertex("broadcasters", "control loop:\nbroadcasters", Shape.BOX),
        Vertex("camera", "camera process", Shape.BOX),
        Vertex("states", "subscribers"),
        Vertex("pictures", "subscribers of pictures"),
    ),
    (
        Edge("user", "executor", "/position_controller/commands"),
        Edge("executor", "controllers", "the latest command, without a lock"),
        Edge("controllers", "physics", "commands on the interfaces"),
        Edge("physics", "broadcasters", "the state at the end of the period"),
        Edge("physics", "camera", "a snapshot of the state"),
        Edge("broadcasters", "states", "/joint_states, /clock"),
        Edge("camera", "pictures", "/videocamera"),
    ),
)
"""The way of a command through one control period."""

DRAWINGS = {"command.svg": COMMAND}


def drawing(name: str) -> str:
    """Return a drawing as SVG."""
    return to_svg(DRAWINGS[name], downward=True)


def main() -> None:
    """Write all drawings."""
    for name in DRAWINGS:
        (IMAGES / name).write_text(drawing(name))


if __name__ == "__main__":
    main()
