"""`arm topic hz`: the rate of a topic."""

import argparse
import time
from typing import Any

from arm_cli.measurements.rate import RateWindow
from arm_cli.ros.connection import connect
from arm_cli.topic.measuring import add_measuring_arguments, report_every_second

WINDOW = 10000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_measuring_arguments(parser, WINDOW)


def run(options: argparse.Namespace) -> None:
    """Print the rate every second.

    Raises:
        StoppedError: a signal ends it.
    """
    window = RateWindow(options.window)
    with connect(use_sim_time=options.use_sim_time) as session:
        from arm_cli.ros.topic_listener import TopicListener

        clock = session.clock_ns if options.use_sim_time else time.monotonic_ns
        listener = TopicListener(session, options.topic_name)

        def take(_: Any) -> None:
            window.add(clock())

        listener.subscribe(listener.wait_for_class(), take, raw=True)
        report_every_second(session, window.describe, listener.silence)
