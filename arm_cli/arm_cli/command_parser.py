"""The argument parser of every verb: errors are one sentence and name what was near."""

import argparse
import re
from collections.abc import Sequence
from typing import NoReturn

EXIT_USAGE = 2
LEAST_NUMBER, LARGEST_NUMBER = 1e-9, 2e9
"""Seconds, and times a second: ROS has a ns as the least time, and 32 bits for whole seconds."""
LARGEST_WHOLE_NUMBER = 2**63 - 1


class CommandParser(argparse.ArgumentParser):
    """An ArgumentParser without abbreviations, with short errors."""

    def __init__(self, program: str, description: str) -> None:
        """Make it for a verb, such as "arm topic echo"."""
        super().__init__(prog=program, description=description, allow_abbrev=False)
        # Nobody needs them, there is no daemon; but lines written for ros2 have them.
        self.add_argument("--no-daemon", action="store_true", help=argparse.SUPPRESS)
        self.add_argument("--spin-time", type=float, metavar="SECONDS", help=argparse.SUPPRESS)

    def parse_words(self, words: Sequence[str]) -> argparse.Namespace:
        """Return the options; what is wrong with the words ends the process with exit code 2."""
        options, unknown = self.parse_known_intermixed_args(words)
        if not unknown:
            return options
        word = unknown[0]
        if not word.startswith("-"):
            self.error(f"too many words, from {word!r} on")
        from launch_py.near_names import describe_known

        known = [
            name
            for name, action in self._option_string_actions.items()
            if name.startswith("--") and action.help != argparse.SUPPRESS
        ]
        self.error(f"no option {word}; {describe_known(word, known)}")

    def error(self, message: str) -> NoReturn:
        """Say it in one line and end with exit code 2."""
        self.exit(EXIT_USAGE, f"{self.prog}: {message}; see {self.prog} --help\n")


def positive_number(text: str) -> float:
    """Convert an option's value to a float above 0, a time or a rate in ROS, for argparse."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is no number above 0")
    if not LEAST_NUMBER <= value <= LARGEST_NUMBER:
        raise argparse.ArgumentTypeError(f"{text!r} is not between 1e-9 and 2e9")
    return value


def positive_number_or_zero(text: str) -> float:
    """Convert an option's value to a float of at least 0, for argparse."""
    return 0.0 if text in ("0", "0.0") else positive_number(text)


def whole_number(text: str, largest: int = LARGEST_WHOLE_NUMBER) -> int:
    """Convert an option's value to an int of at least 0 and at most `largest`, for argparse."""
    if not text.isascii() or not text.isdigit():
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number")
    # Python converts no text of thousands of digits.
    digits = text.lstrip("0") or "0"
    if len(digits) > len(str(largest)) or int(digits) > largest:
        raise argparse.ArgumentTypeError(f"{text} is too large: at most {largest}")
    return int(digits)


def node_name(text: str) -> str:
    """Check the name that an option gives to a node, by the rules of ROS, for argparse."""
    if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]{0,254}", text):
        raise argparse.ArgumentTypeError(
            f"{text!r} is no name of a node: letters, digits and underscores, no digit first"
        )
    return text


def positive_whole_number(text: str) -> int:
    """Convert an option's value to an int of at least 1, for argparse."""
    value = whole_number(text)
    if value == 0:
        raise argparse.ArgumentTypeError("0 is too small: at least 1")
    return value
