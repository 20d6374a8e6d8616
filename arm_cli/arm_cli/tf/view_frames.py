"""`arm tf view_frames`: the tree of frames as a picture."""

import argparse
import time
from pathlib import Path

from arm_cli.command_parser import positive_number
from arm_cli.drawing.dot import has_graphviz
from arm_cli.drawing.picture_file import write_picture
from arm_cli.frames.frame_log import FrameHistory, FrameLog
from arm_cli.ros.connection import connect
from arm_cli.tf.listening import listen
from arm_viewer.drawing.digraph import Digraph, Edge, Vertex

LISTEN_S = 5.0
BROADCASTER = "default_authority"
"""What tf2 says of everybody who broadcasts over ROS 2."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument(
        "-t",
        "--wait-time",
        type=positive_number,
        default=LISTEN_S,
        metavar="SECONDS",
        help=f"listen so long (default {LISTEN_S:g})",
    )
    parser.add_argument(
        "-o", "--output", metavar="STEM", help="file name without suffix (default frames_DATE)"
    )


def run(options: argparse.Namespace) -> None:
    """Write the picture, and its source for graphviz beside it.

    Raises:
        UnansweredError: nobody publishes transforms.
        UsageError: the file cannot be written.
    """
    stem = options.output or time.strftime("frames_%Y-%m-%d_%H.%M.%S")
    print(f"Listening to tf data for {options.wait_time:g} seconds...")
    with connect() as session:
        log = listen(session, options.wait_time)
    print("Generating graph...")
    print(export(log, Path(stem)))


def export(log: FrameLog, stem: Path) -> str:
    """Write the tree of frames, and return what is to be said of it.

    Raises:
        UsageError: the file cannot be written.
    """
    picture = write_picture(frame_graph(log), stem, downward=True)
    said = f"Exported graph to {picture}"
    if picture.suffix == ".pdf":
        return said
    if has_graphviz():
        return f"{said}; no PDF, for graphviz' dot failed: dot -Tpdf {picture.with_suffix('.gv')}"
    return f"{said}; no PDF, for there is no graphviz: apt install graphviz"


def frame_graph(log: FrameLog) -> Digraph:
    """Return the tree of frames to be drawn."""
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
