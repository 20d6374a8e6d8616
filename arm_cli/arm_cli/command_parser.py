"""The argument parser of every verb: errors are one sentence and suggest similar names."""

import argparse
import re
from collections.abc import Sequence
from typing import Any, NoReturn

from arm_node.printable import printable

EXIT_USAGE = 2
LEAST_NUMBER, LARGEST_NUMBER = 1e-9, 2e9
"""Limits of times in seconds and of rates: ROS counts nanoseconds, and seconds in 32 bits."""
LARGEST_WHOLE_NUMBER = 2**63 - 1


_OF_ANY_LENGTH = (argparse.ZERO_OR_MORE, argparse.REMAINDER)
"""Positional arguments that argparse names as required, although it accepts none."""


class CommandParser(argparse.ArgumentParser):
    """An ArgumentParser without abbreviations and with short errors."""

    def __init__(self, program: str, description: str) -> None:
        """Create the parser of a verb, such as "arm topic echo"."""
        super().__init__(prog=program, description=description, allow_abbrev=False)
        # Accepted because command lines for ros2 use them. There is no daemon here.
        self.add_argument("--no-daemon", action="store_true", help=argparse.SUPPRESS)
        self.add_argument("--spin-time", type=float, metavar="SECONDS", help=argparse.SUPPRESS)

    def add_argument(self, *names: str, **settings: Any) -> argparse.Action:
        """Add an argument; the parser's error about missing ones names only required ones."""
        action = super().add_argument(*names, **settings)
        if not action.option_strings and action.nargs in _OF_ANY_LENGTH:
            action.required = False
        return action

    def parse_words(self, words: Sequence[str]) -> argparse.Namespace:
        """Return the parsed options; a mistake ends the process with exit code 2."""
        options, unknown = self.parse_known_intermixed_args(words)
        if not unknown:
            return options
        word = unknown[0]
        if not word.startswith("-"):
            self.error(f"too many arguments, starting with {word!r}")
        from arm_node.names import describe_known

        known = [
            name
            for name, action in self._option_string_actions.items()
            if name.startswith("--") and action.help != argparse.SUPPRESS
        ]
        self.error(f"no option {word}; {describe_known(word, known)}")

    def error(self, message: str) -> NoReturn:
        """Print the message in one line and exit with code 2."""
        self.exit(EXIT_USAGE, printable(f"{self.prog}: {message}; see {self.prog} --help") + "\n")


def positive_number(text: str) -> float:
    """Convert an option's value to a float above 0, a time or a rate, for argparse."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number above 0")
    if not LEAST_NUMBER <= value <= LARGEST_NUMBER:
        raise argparse.ArgumentTypeError(f"{text!r} is not between 1e-9 and 2e9")
    return value


def positive_number_or_zero(text: str) -> float:
    """Convert an option's value to a float of at least 0, for argparse."""
    return 0.0 if text in ("0", "0.0") else positive_number(text)


def whole_number(text: str, largest: int = LARGEST_WHOLE_NUMBER) -> int:
    """Convert an option's value to an int of at least 0 and at most `largest`, for argparse."""
    if not text.isascii() or not text.isdigit():
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number")
    # Python refuses to convert a text with thousands of digits.
    digits = text.lstrip("0") or "0"
    if len(digits) > len(str(largest)) or int(digits) > largest:
        raise argparse.ArgumentTypeError(f"{text} is too large: the largest value is {largest}")
    return int(digits)


def node_name(text: str) -> str:
    """Check that an option's value is a valid ROS node name, for argparse."""
    if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]{0,254}", text):
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a node name: use letters, digits and underscores, and no digit first"
        )
    return text


def positive_whole_number(text: str) -> int:
    """Convert an option's value to an int of at least 1, for argparse."""
    value = whole_number(text)
    if value == 0:
        raise argparse.ArgumentTypeError("0 is too small: the smallest value is 1")
    return value
