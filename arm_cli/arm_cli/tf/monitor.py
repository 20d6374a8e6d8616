"""`arm tf monitor`: prints how late the transforms of each frame arrive, as tf2_monitor does."""

import argparse
from collections.abc import Iterator

from arm_cli.arguments import Argument, Flag, verb
from arm_cli.errors import CommandUsageError
from arm_cli.output import say_document
from arm_cli.ros.connection import connect
from arm_cli.tf.frame_log import FrameLog
from arm_cli.tf.tree import BROADCASTER

PERIOD_S = 1.0
SETTLE_S = 2.0


@verb(
    Argument("source_frame", nargs="?", help="with a target: only the frames between"),
    Argument("target_frame", nargs="?", help="the other end"),
    Flag("--once", help="print once and end"),
)
def run(options: argparse.Namespace) -> None:
    """Print the delays every second.

    Raises:
        CommandUsageError: there is one frame; all frames, or two, can be shown.
        NoSuchNameError: there is no such frame, or the two are in different trees.
    """
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
