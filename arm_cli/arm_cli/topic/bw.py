"""`arm topic bw`: the bandwidth of a topic."""

import argparse
import time

from arm_cli.measurements.bandwidth import BandwidthWindow
from arm_cli.ros.connection import connect
from arm_cli.topic.measuring import add_measuring_arguments, report_every_second

WINDOW = 100


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_measuring_arguments(parser, WINDOW)


def run(options: argparse.Namespace) -> None:
    """Print the bandwidth every second.

    Raises:
        StoppedError: a signal ends it.
    """
    window = BandwidthWindow(options.window)
    with connect(use_sim_time=options.use_sim_time) as session:
        from arm_cli.ros.topic_listener import TopicListener

        clock = session.clock_s if options.use_sim_time else time.monotonic
        listener = TopicListener(session, options.topic_name)

        def take(data: bytes) -> None:
            window.add(clock(), len(data))

        listener.subscribe(listener.wait_for_class(), take, raw=True)
        print(f"Subscribed to [{listener.topic}]")
        report_every_second(session, lambda: window.describe(clock()), listener.silence)
