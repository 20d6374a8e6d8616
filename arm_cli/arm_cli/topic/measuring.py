"""`arm topic hz`, `bw` and `delay`: measures a topic and reports every second."""

import argparse
import math
import time
from collections import deque
from collections.abc import Callable, Collection
from typing import TYPE_CHECKING, Any

from arm_cli.arguments import Argument, Flag, positive_whole_number, verb
from arm_cli.errors import MessageError
from arm_cli.output import complain, say, say_document
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.topic.message_parts import FILTER, message_filter

if TYPE_CHECKING:
    from arm_cli.ros.session import CommandSession


class RateWindow:
    """The intervals between the last messages.

    Times are in ns of any clock. A jump back in time resets the window.

    Attributes:
        taken: the number of messages so far.
    """

    def __init__(self, size: int) -> None:
        """Keep at most `size` intervals."""
        self.taken = 0
        self._intervals_ns: deque[int] = deque(maxlen=size)
        self._last_ns: int | None = None

    def add(self, now_ns: int) -> None:
        """Add a message that arrived at a time."""
        self.taken += 1
        if self._last_ns is not None:
            if now_ns < self._last_ns:
                self._intervals_ns.clear()
            else:
                self._intervals_ns.append(now_ns - self._last_ns)
        self._last_ns = now_ns

    def describe(self) -> str | None:
        """Return the two lines that ros2 prints, None before the second message."""
        intervals = self._intervals_ns
        if not intervals:
            return None
        mean = sum(intervals) / len(intervals)
        rate = 1e9 / mean if mean > 0 else 0.0
        return f"average rate: {rate:.3f}\n{_spread(intervals)}"


class BandwidthWindow:
    """The arrival times and sizes of the last messages."""

    def __init__(self, size: int) -> None:
        """Keep at most `size` messages."""
        self._messages: deque[tuple[float, int]] = deque(maxlen=size)

    def add(self, now_s: float, size: int) -> None:
        """Add a message of `size` bytes that arrived at a time."""
        self._messages.append((now_s, size))

    def describe(self, now_s: float) -> str | None:
        """Return the two lines that ros2 prints, None before the second message."""
        if len(self._messages) < 2 or now_s <= self._messages[0][0]:
            return None
        sizes = [size for _, size in self._messages]
        per_second = sum(sizes) / (now_s - self._messages[0][0])
        divisor, digits, unit = _unit(per_second)
        rate, mean, low, high = (
            f"{value / divisor:.{digits}f} {unit}"
            for value in (per_second, sum(sizes) / len(sizes), min(sizes), max(sizes))
        )
        return (
            f"{rate}/s from {len(sizes)} messages\n"
            f"\tMessage size mean: {mean} min: {low} max: {high}"
        )


def _unit(per_second: float) -> tuple[int, int, str]:
    if per_second < 1000:
        return 1, 0, "B"
    return (1000, 2, "KB") if per_second < 1_000_000 else (1_000_000, 2, "MB")


class DelayWindow:
    """The ages of the last messages in ns.

    Attributes:
        taken: the number of messages so far.
    """

    def __init__(self, size: int) -> None:
        """Keep at most `size` messages."""
        self.taken = 0
        self._delays_ns: deque[int] = deque(maxlen=size)

    def add(self, delay_ns: int) -> None:
        """Add a message of some age."""
        self.taken += 1
        self._delays_ns.append(delay_ns)

    def describe(self) -> str | None:
        """Return the two lines that ros2 prints, None before the first message."""
        delays = self._delays_ns
        if not delays:
            return None
        return f"average delay: {sum(delays) / len(delays) * 1e-9:.3f}\n{_spread(delays)}"


def _spread(durations_ns: Collection[int]) -> str:
    """Return the second line that ros2 prints for rates and delays."""
    count = len(durations_ns)
    mean = sum(durations_ns) / count
    deviation = math.sqrt(sum((x - mean) ** 2 for x in durations_ns) / count)
    return (
        f"\tmin: {min(durations_ns) * 1e-9:.3f}s max: {max(durations_ns) * 1e-9:.3f}s "
        f"std dev: {deviation * 1e-9:.5f}s window: {count}"
    )


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

    `silence` returns a notice for when no message arrives at first. A second without new messages,
    as `taken` counts them, is not reported; without it, the measurement also changes then.
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
    """Print the rate every second."""
    fits = message_filter(options.filter) if options.filter else None
    window = RateWindow(options.window)
    with connect(use_sim_time=options.use_sim_time) as session:
        from arm_cli.ros.listeners import TopicListener

        clock = session.clock_ns if options.use_sim_time else time.monotonic_ns
        listener = TopicListener(session, options.topic_name)

        def take(message: Any) -> None:
            if fits is None or fits(message):
                window.add(clock())

        listener.subscribe(listener.wait_for_class(), take, raw=fits is None)
        report_every_second(session, window.describe, listener.silence, lambda: window.taken)


@verb(*_measured(FEW_MESSAGES))
def bw(options: argparse.Namespace) -> None:
    """Print the bandwidth every second."""
    window = BandwidthWindow(options.window)
    with connect(use_sim_time=options.use_sim_time) as session:
        from arm_cli.ros.listeners import TopicListener

        clock = session.clock_s if options.use_sim_time else time.monotonic
        listener = TopicListener(session, options.topic_name)

        def take(data: bytes) -> None:
            window.add(clock(), len(data))

        listener.subscribe(listener.wait_for_class(), take, raw=True)
        say(f"Subscribed to [{listener.topic}]")
        report_every_second(session, lambda: window.describe(clock()), listener.silence)


@verb(*_measured(MANY_MESSAGES))
def delay(options: argparse.Namespace) -> None:
    """Print the age of the stamps on arrival, every second."""
    window = DelayWindow(options.window)
    with connect(use_sim_time=options.use_sim_time) as session:
        from arm_cli.ros.listeners import TopicListener

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
