"""`arm calibrate`: finds the middle and the ends of a real arm's joints, moved by hand."""

import argparse
import select
import sys
from collections.abc import Sequence
from pathlib import Path

from arm_cli.arguments import Argument, positive_number, verb
from arm_cli.errors import ArmCliError, CommandUsageError
from arm_cli.output import say

POLL_S = 0.02
REPLY_TIMEOUT_S = 0.05
DEFAULT_BAUD = 1_000_000


@verb(
    Argument("file", metavar="FILE", help="calibration file to write, for calibration:=FILE"),
    Argument(
        "joints",
        metavar="JOINT[=ID]",
        nargs="+",
        help="the joints of the description; without =ID the first has servo 1, and so on",
    ),
    Argument(
        "--port",
        metavar="PORT",
        default="/dev/ttyUSB0",
        help="serial port of Feetech's servos (default: %(default)s)",
    ),
    Argument(
        "--baud",
        metavar="BAUD",
        type=positive_number,
        default=DEFAULT_BAUD,
        help="bits per second (default: %(default)s)",
    ),
)
def calibrate(options: argparse.Namespace) -> None:
    """Switch the joints off, ask for the middle and the ends, and write the file.

    Nothing in the servos is changed but their power, which stays off.
    """
    # Imported here, because only this verb talks to servos.
    from arm_drivers.calibration import write_calibration
    from arm_drivers.errors import DriverError
    from arm_drivers.feetech.bus import FeetechBus
    from arm_drivers.feetech.hand_calibration import HandCalibration
    from arm_drivers.serial_line import SerialLine

    joints = joints_of(options.joints)
    try:
        line = SerialLine(options.port, int(options.baud))
        try:
            hand = HandCalibration(FeetechBus(line, REPLY_TIMEOUT_S), joints)
            _ask("The joints are switched off now, and the arm may fall: hold it.")
            hand.release()
            _ask("Put every joint where the description has 0 rad.")
            hand.take_middle()
            say("Move each joint to both of its ends. Then press Enter.")
            while not _entered(POLL_S):
                hand.take_positions()
            write_calibration(Path(options.file), hand.result())
        finally:
            line.close()
    except DriverError as error:
        raise ArmCliError(str(error)) from error
    for joint in joints:
        say(f"{joint}: {hand.lowest[joint]} to {hand.highest[joint]}")
    say(f"wrote {options.file}; a joint that turns the wrong way needs drive_mode 1 there")


def joints_of(words: Sequence[str]) -> dict[str, int]:
    """Return the id of each joint's servo.

    Raises:
        CommandUsageError: a word is not a joint, or a joint or an id stands twice.
    """
    joints: dict[str, int] = {}
    for place, word in enumerate(words, 1):
        name, separator, text = word.partition("=")
        if not name or (separator and not (text.isdecimal() and int(text) <= 252)):
            raise CommandUsageError(f"'{word}' is not JOINT or JOINT=ID with an id up to 252")
        number = int(text) if separator else place
        if name in joints or number in joints.values():
            raise CommandUsageError(f"joint '{name}' or its servo {number} is given twice")
        joints[name] = number
    return joints


def _ask(sentence: str) -> None:
    say(f"{sentence} Press Enter to go on, Ctrl-C to stop.")
    while not _entered(1.0):
        pass


def _entered(timeout_s: float) -> bool:
    """Return whether Enter was pressed within a time.

    Raises:
        CommandUsageError: nobody is there to press it.
    """
    if not select.select([sys.stdin], [], [], timeout_s)[0]:
        return False
    if not sys.stdin.readline():
        raise CommandUsageError("arm calibrate needs someone at the keyboard: run it in a terminal")
    return True
