"""`arm topic delay`: the age of a topic's stamps."""

import argparse
from typing import Any

from arm_cli.errors import MessageError
from arm_cli.measurements.delay import DelayWindow
from arm_cli.ros.connection import connect
from arm_cli.topic.measuring import add_measuring_arguments, report_every_second

WINDOW = 10000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_measuring_arguments(parser, WINDOW)


def run(options: argparse.Namespace) -> None:
    """Print how old the stamps are on arrival, every second.

    Raises:
        MessageError: the topic's messages have no header.
        StoppedError: a signal ends it.
    """
    window = DelayWindow(options.window)
    with connect(use_sim_time=options.use_sim_time) as session:
        from arm_cli.ros.topic_listener import TopicListener

        listener = TopicListener(session, options.topic_name)
        message_class: Any = listener.wait_for_class()
        if "header" not in message_class.get_fields_and_field_types():
            raise MessageError(f"the messages of {listener.topic} have no header, so no stamp")

        def take(message: Any) -> None:
            stamp = message.header.stamp
            window.add(session.clock_ns() - stamp.sec * 1_000_000_000 - stamp.nanosec)

        listener.subscribe(message_class, take)
        report_every_second(session, window.describe, listener.silence, lambda: window.taken)
