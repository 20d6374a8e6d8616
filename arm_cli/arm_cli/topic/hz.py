"""`arm topic hz`: the rate of a topic."""

import argparse
import time
from typing import Any

from arm_cli.measurements.rate import RateWindow
from arm_cli.messages.message_filter import add_filter_argument, message_filter
from arm_cli.ros.connection import connect
from arm_cli.topic.measuring import add_measuring_arguments, report_every_second

WINDOW = 10000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_measuring_arguments(parser, WINDOW)
    parser.add_argument(
        "--wall-time",
        dest="use_sim_time",
        action="store_false",
        help="go by the wall clock, as by default",
    )
    add_filter_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the rate every second.

    Raises:
        UsageError: the filter is no Python expression.
        MessageError: it does not fit the messages.
        StoppedError: a signal ends it.
    """
    fits = message_filter(options.filter) if options.filter else None
    window = RateWindow(options.window)
    with connect(use_sim_time=options.use_sim_time) as session:
        from arm_cli.ros.topic_listener import TopicListener

        clock = session.clock_ns if options.use_sim_time else time.monotonic_ns
        listener = TopicListener(session, options.topic_name)

        def take(message: Any) -> None:
            if fits is None or fits(message):
                window.add(clock())

        listener.subscribe(listener.wait_for_class(), take, raw=fits is None)
        report_every_second(session, window.describe, listener.silence, lambda: window.taken)
