"""The verbs of `arm tf`, with the output of tf2_echo, tf2_monitor and view_frames."""

import argparse
import math
import time
from collections.abc import Iterable, Iterator
from pathlib import Path

from arm_cli.arguments import JSON, Argument, Flag, positive_number, verb
from arm_cli.errors import CommandUsageError, NoSuchNameError
from arm_cli.graph_files import has_graphviz, write_picture
from arm_cli.output import print_json, say, say_answer, say_document
from arm_cli.ros.connection import connect
from arm_cli.tf.frame_log import FrameHistory, FrameLog, Lookup
from arm_node.drawing import Digraph, Edge, Vertex

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


@verb(_wait_time(TREE_LISTEN_S), JSON)
def tree(options: argparse.Namespace) -> None:
    """Print the tree."""
    with connect() as session:
        from arm_cli.tf.ros_listener import listen

        log = listen(session, options.wait_time)
    frames = {
        name: {"parent": h.parent, "static": h.static, "rate_hz": h.rate_hz}
        for name, h in sorted(log.frames.items())
    }
    say_answer(options, frames, log.draw_tree())


@verb(
    _wait_time(VIEW_LISTEN_S),
    Argument(
        "-o", "--output", metavar="STEM", help="file name without suffix (default frames_DATE)"
    ),
)
def view_frames(options: argparse.Namespace) -> None:
    """Write the picture and its graphviz source."""
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


@verb(
    Argument("source_frame", help="such as base_link"),
    Argument("target_frame", help="frame whose pose in the source frame to print"),
    Argument(
        "rate",
        nargs="?",
        type=positive_number,
        default=1.0,
        help="how often to print, in Hz (default 1)",
    ),
    Flag("--once", help="print once and end"),
    JSON,
)
def echo(options: argparse.Namespace) -> None:
    """Print the transform repeatedly."""
    source, target = (f.lstrip("/") for f in (options.source_frame, options.target_frame))
    with connect() as session:
        from arm_cli.tf.ros_listener import listen

        log = listen(session, 0.0)

        def connected() -> bool:
            try:
                log.lookup(source, target)
            except NoSuchNameError:
                return False
            return True

        session.wait_until(connected, timeout_s=SETTLE_S)
        while True:
            lookup = log.lookup(source, target)
            if options.json:
                pose = lookup.pose
                print_json(
                    {
                        "stamp_s": lookup.stamp_s,
                        "translation": pose.position,
                        "quaternion": pose.rotation,
                    }
                )
            else:
                say_document(describe_lookup(lookup))
            if options.once:
                return
            session.spin_for(1.0 / options.rate)


def describe_lookup(lookup: Lookup) -> str:
    """Return the lines that tf2_echo prints for a transform."""
    pose = lookup.pose
    rpy = pose.rpy()
    seconds, nanoseconds = divmod(round(lookup.stamp_s * 1e9), 1_000_000_000)
    return "\n".join(
        [
            f"At time {seconds}.{nanoseconds:09d}",
            f"- Translation: {_numbers(pose.position)}",
            f"- Rotation: in Quaternion (xyzw) {_numbers(pose.rotation)}",
            f"- Rotation: in RPY (radian) {_numbers(rpy)}",
            f"- Rotation: in RPY (degree) {_numbers(math.degrees(angle) for angle in rpy)}",
            "- Matrix:",
            *("".join(f" {_rounded(value):6.3f}" for value in row) for row in pose.matrix()),
        ]
    )


def _numbers(values: Iterable[float]) -> str:
    return f"[{', '.join(f'{_rounded(value):.3f}' for value in values)}]"


def _rounded(value: float) -> float:
    # Adding 0 turns -0 into 0.
    return round(value, 3) + 0.0


PERIOD_S = 1.0
SETTLE_S = 2.0


@verb(
    Argument("source_frame", nargs="?", help="with a target: only the frames between"),
    Argument("target_frame", nargs="?", help="the other end"),
    Flag("--once", help="print once and end"),
)
def monitor(options: argparse.Namespace) -> None:
    """Print the delays every second."""
    ends = [f.lstrip("/") for f in (options.source_frame, options.target_frame) if f is not None]
    if len(ends) == 1:
        raise CommandUsageError("name two frames, or none for all of them")
    with connect() as session:
        from arm_cli.tf.ros_listener import listen

        # As tf2_monitor, which a launch file may start before anybody publishes.
        log = listen(session, SETTLE_S, timeout_s=None)
        while True:
            say_document("\n".join(describe_delays(log, ends)))
            if options.once:
                return
            session.spin_for(PERIOD_S)


def describe_delays(log: FrameLog, ends: list[str]) -> Iterator[str]:
    """Yield the lines that tf2_monitor prints, for all frames or for those between two.

    Raises:
        NoSuchNameError: see `FrameLog.lookup`.
    """
    shown = list(log.frames)
    yield f"RESULTS: for {' to '.join(ends) if ends else 'all Frames'}"
    if ends:
        shown = log.path(*ends)
        yield f"Chain is: {' -> '.join(shown)}"
        delays = [log.frames[f].delays_s for f in shown if f in log.frames]
        moving = [delay for delay in delays if delay]
        mean = max((sum(d) / len(d) for d in moving), default=0.0)
        worst = max((max(d) for d in moving), default=0.0)
        yield f"Net delay     avg = {mean:g}: max = {worst:g}"
    yield ""
    yield "Frames:"
    for name in sorted(set(shown) & log.frames.keys()):
        history = log.frames[name]
        by = f"Frame: {name}, published by <{BROADCASTER}>"
        if not history.delays_s:
            yield f"{by}, static"
            continue
        mean = sum(history.delays_s) / len(history.delays_s)
        yield f"{by}, Average Delay: {mean:g}, Max Delay: {max(history.delays_s):g}"
    yield ""
    yield "All Broadcasters:"
    moving = [history for history in log.frames.values() if history.delays_s]
    delays = [delay for history in moving for delay in history.delays_s]
    rate_hz = max((history.rate_hz for history in moving), default=0.0)
    mean = sum(delays) / len(delays) if delays else 0.0
    worst = max(delays, default=0.0)
    yield f"Node: <{BROADCASTER}> {rate_hz:g} Hz, Average Delay: {mean:g} Max Delay: {worst:g}"
