"""`arm tf tree` and `view_frames`: prints and draws the tree of frames."""

import argparse
import time
from pathlib import Path

from arm_cli.arguments import JSON, Argument, positive_number, verb
from arm_cli.graph_files import has_graphviz, write_picture
from arm_cli.output import print_json, say
from arm_cli.ros.connection import connect
from arm_cli.tf.frame_log import FrameHistory, FrameLog
from arm_node.drawing.digraph import Digraph, Edge, Vertex

TREE_LISTEN_S, VIEW_LISTEN_S = 1.0, 5.0

BROADCASTER = "default_authority"
"""The name that tf2 gives to every broadcaster on ROS 2."""


def _wait_time(default_s: float) -> Argument:
    return Argument(
        "-t",
        "--wait-time",
        type=positive_number,
        default=default_s,
        metavar="SECONDS",
        help=f"how long to listen (default {default_s:g})",
    )


@verb(
    _wait_time(TREE_LISTEN_S),
    JSON,
)
def print_tree(options: argparse.Namespace) -> None:
    """Print the tree.

    Raises:
        UnansweredError: nobody publishes transforms.
    """
    with connect() as session:
        from arm_cli.tf.ros_listener import listen

        log = listen(session, options.wait_time)
    if options.json:
        print_json(
            {
                name: {"parent": h.parent, "static": h.static, "rate_hz": h.rate_hz}
                for name, h in sorted(log.frames.items())
            }
        )
    else:
        say(*log.draw_tree())


@verb(
    _wait_time(VIEW_LISTEN_S),
    Argument(
        "-o", "--output", metavar="STEM", help="file name without suffix (default frames_DATE)"
    ),
)
def view_frames(options: argparse.Namespace) -> None:
    """Write the picture and its graphviz source.

    Raises:
        UnansweredError: nobody publishes transforms.
        CommandUsageError: the file cannot be written.
    """
    stem = options.output or time.strftime("frames_%Y-%m-%d_%H.%M.%S")
    say(f"Listening to tf data for {options.wait_time:g} seconds...")
    with connect() as session:
        from arm_cli.tf.ros_listener import listen

        log = listen(session, options.wait_time)
    say("Generating graph...")
    say(export(log, Path(stem)))


def export(log: FrameLog, stem: Path) -> str:
    """Write the tree of frames; return a message for the user.

    Raises:
        CommandUsageError: the file cannot be written.
    """
    picture = write_picture(frame_graph(log), stem, downward=True)
    message = f"Exported graph to {picture}"
    if picture.suffix == ".pdf":
        return message
    if has_graphviz():
        source = picture.with_suffix(".gv")
        return f"{message}; no PDF, because graphviz' dot failed: dot -Tpdf {source}"
    return f"{message}; no PDF, because graphviz is not installed: apt install graphviz"


def frame_graph(log: FrameLog) -> Digraph:
    """Return the graph to draw for the tree of frames."""
    return Digraph(
        tuple(Vertex(name, name) for name in log.names()),
        tuple(Edge(h.parent, name, _describe(h)) for name, h in sorted(log.frames.items())),
    )


def _describe(history: FrameHistory) -> str:
    oldest, latest = (0.0, 0.0) if history.static else (history.stamps_s[0], history.stamps_s[-1])
    return "\n".join(
        [
            f"Broadcaster: {BROADCASTER}",
            f"Average rate: {history.rate_hz:.3f}",
            f"Buffer length: {0.0 if history.static else history.span_s:.3f}",
            f"Most recent transform: {latest:.6f}",
            f"Oldest transform: {oldest:.6f}",
        ]
    )
