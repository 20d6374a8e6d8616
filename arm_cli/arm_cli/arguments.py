"""The arguments of verbs: how a verb declares them, their parser, and types of their values.

    @verb(Argument("topic_name", completer=completers.topics, help="such as /joint_states"), JSON)
    def info(options: argparse.Namespace) -> None:
        ...

The parser's errors are one sentence and suggest similar names.
"""

import argparse
import math
import re
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NoReturn, Protocol

from arm_node.frozen import frozen
from arm_node.printable import printable

EXIT_USAGE = 2
LEAST_NUMBER, LARGEST_NUMBER = 1e-9, 2e9
"""Limits of times in seconds and of rates: ROS counts nanoseconds, and seconds in 32 bits."""
LARGEST_WHOLE_NUMBER = 2**63 - 1


_OF_ANY_LENGTH = (argparse.ZERO_OR_MORE, argparse.REMAINDER)
"""Positional arguments that argparse names as required, although it accepts none."""


Completer = Callable[..., Iterable[str]]
"""Returns the possible words of an argument, for the Tab key; see `arm_cli.word_completion`."""


class _Container(Protocol):
    """A parser, or a group of its arguments."""

    def add_argument(self, *names: str, **settings: Any) -> argparse.Action: ...


class Declaration(Protocol):
    """What a verb declares: an argument, or a group of them."""

    def add_to(self, parser: argparse.ArgumentParser) -> None:
        """Add it to the verb's parser."""
        ...


class Argument:
    """An argument of a verb.

    Args:
        names: as for `argparse.ArgumentParser.add_argument`.
        completer: completes its value; None completes nothing.
        settings: as for `add_argument`.
    """

    def __init__(self, *names: str, completer: Completer | None = None, **settings: Any) -> None:
        self._names, self._completer, self._settings = names, completer, settings

    def add_to(self, parser: _Container) -> None:
        """Add it to a parser or to a group."""
        action = parser.add_argument(*self._names, **self._settings)
        if self._completer is not None:
            action.completer = self._completer  # pyright: ignore[reportAttributeAccessIssue]


class Flag(Argument):
    """An option without a value: true if it is given."""

    def __init__(self, *names: str, **settings: Any) -> None:
        super().__init__(*names, action="store_true", **settings)


class Group:
    """Arguments below a heading of their own in the help."""

    def __init__(self, title: str, *arguments: Argument, description: str | None = None) -> None:
        self._title, self._description, self._arguments = title, description, arguments

    def add_to(self, parser: argparse.ArgumentParser) -> None:
        """Add the group."""
        group = parser.add_argument_group(self._title, self._description)
        for argument in self._arguments:
            argument.add_to(group)


class Exclusive:
    """Arguments that exclude each other."""

    def __init__(self, *arguments: Argument) -> None:
        self._arguments = arguments

    def add_to(self, parser: argparse.ArgumentParser) -> None:
        """Add the arguments."""
        group = parser.add_mutually_exclusive_group()
        for argument in self._arguments:
            argument.add_to(group)


JSON = Flag("--json", help="print JSON, for scripts")

Run = Callable[[argparse.Namespace], int | None]
"""Runs a verb; its result is the exit code, None for 0."""


@frozen
class VerbFunction:
    """The function that runs a verb, with the verb's arguments."""

    run: Run
    arguments: Sequence[Declaration]
    epilog: str | None

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        """Add the arguments to a parser."""
        for argument in self.arguments:
            argument.add_to(parser)
        parser.epilog = self.epilog


def verb(*arguments: Declaration, epilog: str | None = None) -> Callable[[Run], VerbFunction]:
    """Declare a verb: decorates the function that runs it, and may return an exit code.

    Whatever the user can mend, the function raises as an `ArmCliError`, which becomes one line on
    stderr (see `run_reporting_errors`). Its docstring does not list these errors.

    Args:
        arguments: its arguments, in the order of the help.
        epilog: the text at the end of the help.
    """
    return lambda run: VerbFunction(run, arguments, epilog)


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


def finite_number(text: str) -> float:
    """Convert an option's value to a float that is neither infinite nor nan, for argparse."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number")
    return value


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
