"""What `arm topic hz`, `bw` and `delay` share: their arguments, and a report every second."""

import argparse
from collections.abc import Callable
from typing import TYPE_CHECKING

from arm_cli.command_parser import positive_whole_number
from arm_cli.ros import completers
from arm_cli.word_completion import complete_with

if TYPE_CHECKING:
    from arm_cli.ros.session import Session

REPORT_PERIOD_S = 1.0


def add_measuring_arguments(parser: argparse.ArgumentParser, window: int) -> None:
    """Add the topic, the window and the choice of clock."""
    complete_with(
        parser.add_argument("topic_name", help="such as /joint_states"), completers.topics
    )
    parser.add_argument(
        "-w",
        "--window",
        type=positive_whole_number,
        default=window,
        metavar="N",
        help=f"number of messages to look back at (default {window})",
    )
    parser.add_argument(
        "-s", "--use-sim-time", action="store_true", help="go by /clock instead of the wall clock"
    )


def report_every_second(
    session: "Session",
    describe: Callable[[], str | None],
    silence: Callable[[], str],
    taken: Callable[[], int] | None = None,
) -> None:
    """Print what is measured, every second in which there is something, until a signal comes.

    Args:
        session: to wait with.
        describe: returns the report; None while there is nothing to say.
        silence: says what is waited for while nothing has come yet.
        taken: returns the number of messages so far; there is no report where none came since
            the last one. None: what is measured changes without messages, too.
    """
    reported: int | None = None
    session.wait_until(lambda: describe() is not None, silence)
    while True:
        session.spin_for(REPORT_PERIOD_S)
        count = None if taken is None else taken()
        report = describe()
        if report is not None and (count is None or count != reported):
            print(report)
            reported = count
