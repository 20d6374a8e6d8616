"""The Python expression of `--filter`: which messages count."""

import argparse
from collections.abc import Callable
from typing import Any

from arm_cli.errors import MessageError, UsageError

_RAISED = (ArithmeticError, AttributeError, LookupError, NameError, TypeError, ValueError)
"""What an expression raises that does not fit the messages."""


def add_filter_argument(parser: argparse.ArgumentParser) -> None:
    """Add `--filter`."""
    parser.add_argument(
        "--filter", metavar="EXPRESSION", help="only messages m for which this Python is true"
    )


def message_filter(expression: str) -> Callable[[Any], bool]:
    """Return what says whether a message fits the expression, in which it is called `m`.

    It raises a MessageError where the expression fails for a message.

    Raises:
        UsageError: it is no Python expression.
    """
    try:
        code = compile(expression, "--filter", "eval")
    except (SyntaxError, ValueError) as error:
        raise UsageError(f"--filter {expression!r} is no Python expression") from error

    def fits(message: Any) -> bool:
        try:
            return bool(eval(code, {"m": message}))
        except _RAISED as error:
            text = f"{type(error).__name__}: {error}"
            raise MessageError(f"--filter {expression!r} fails: {text}") from error

    return fits
