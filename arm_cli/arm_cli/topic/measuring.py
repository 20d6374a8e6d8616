"""`arm topic hz`, `bw` and `delay`: measures a topic and reports every second."""

import argparse
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from arm_cli.arguments import Argument, Flag, positive_whole_number, verb
from arm_cli.errors import MessageError
from arm_cli.messages.selection import FILTER, message_filter
from arm_cli.output import complain, say, say_document
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.topic.windows import BandwidthWindow, DelayWindow, RateWindow

if TYPE_CHECKING:
    from arm_cli.ros.session import CommandSession

REPORT_PERIOD_S = 1.0
MANY_MESSAGES, FEW_MESSAGES = 10000, 100
"""The default windows of ros2 topic."""

YEAR_NS = 365 * 24 * 3600 * 1_000_000_000
SIMULATED = (
    "the stamps of {topic} are about {stamp_s} s after the start of a clock, not the time of day: "
    "use -s to measure the delay in simulation time (/clock)"
)


def _measured(window: int) -> tuple[Argument, ...]:
    """Return the arguments for the topic, the window and the clock."""
    return (
        Argument("topic_name", completer=completers.topics, help="such as /joint_states"),
        Argument(
            "-w",
            "--window",
            type=positive_whole_number,
            default=window,
            metavar="N",
            help=f"number of messages to look back at (default {window})",
        ),
        Flag("-s", "--use-sim-time", help="use /clock instead of the wall clock"),
    )


def report_every_second(
    session: "CommandSession",
    describe: Callable[[], str | None],
    silence: Callable[[], str],
    taken: Callable[[], int] | None = None,
) -> None:
    """Print the measurement every second until a signal arrives.

    Args:
        session: the session to wait with.
        describe: returns the report, or None if there is none yet.
        silence: returns a notice to print if no message arrives at first.
        taken: returns the number of messages so far; a second without new messages is not
            reported. None if the measurement also changes without messages.
    """
    reported: int | None = None
    session.wait_until(lambda: describe() is not None, silence)
    while True:
        session.spin_for(REPORT_PERIOD_S)
        count = None if taken is None else taken()
        report = describe()
        if report is not None and (count is None or count != reported):
            say_document(report)
            reported = count


@verb(
    *_measured(MANY_MESSAGES),
    Argument(
        "--wall-time",
        dest="use_sim_time",
        action="store_false",
        help="use the wall clock (default)",
    ),
    FILTER,
)
def hz(options: argparse.Namespace) -> None:
    """Print the rate every second.

    Raises:
        CommandUsageError: the filter is not a Python expression.
        MessageError: the filter does not fit the messages.
        StoppedError: a signal arrived.
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


@verb(
    *_measured(FEW_MESSAGES),
)
def bw(options: argparse.Namespace) -> None:
    """Print the bandwidth every second.

    Raises:
        StoppedError: a signal arrived.
    """
    window = BandwidthWindow(options.window)
    with connect(use_sim_time=options.use_sim_time) as session:
        from arm_cli.ros.topic_listener import TopicListener

        clock = session.clock_s if options.use_sim_time else time.monotonic
        listener = TopicListener(session, options.topic_name)

        def take(data: bytes) -> None:
            window.add(clock(), len(data))

        listener.subscribe(listener.wait_for_class(), take, raw=True)
        say(f"Subscribed to [{listener.topic}]")
        report_every_second(session, lambda: window.describe(clock()), listener.silence)


@verb(
    *_measured(MANY_MESSAGES),
)
def delay(options: argparse.Namespace) -> None:
    """Print the age of the stamps on arrival, every second.

    Raises:
        MessageError: the topic's messages have no header.
        StoppedError: a signal arrived.
    """
    window = DelayWindow(options.window)
    with connect(use_sim_time=options.use_sim_time) as session:
        from arm_cli.ros.topic_listener import TopicListener

        listener = TopicListener(session, options.topic_name)
        message_class: Any = listener.wait_for_class()
        if "header" not in message_class.get_fields_and_field_types():
            raise MessageError(f"the messages of {listener.topic} have no header with a stamp")

        def take(message: Any) -> None:
            stamp = message.header.stamp
            delay_ns = session.clock_ns() - stamp.sec * 1_000_000_000 - stamp.nanosec
            if window.taken == 0 and delay_ns > YEAR_NS and not options.use_sim_time:
                complain(SIMULATED.format(topic=listener.topic, stamp_s=stamp.sec))
            window.add(delay_ns)

        listener.subscribe(message_class, take)
        report_every_second(session, window.describe, listener.silence, lambda: window.taken)
