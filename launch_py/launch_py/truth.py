"""Reads the words for true and false that launch files and command lines use."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launch_py.errors import LaunchFileError
from launch_py.substitution import Text, perform_text

if TYPE_CHECKING:
    from launch_py.launch_context import LaunchContext

TRUE_WORDS = ("true", "1", "yes", "on")
FALSE_WORDS = ("false", "0", "no", "off")


def parse_truth(text: str) -> bool | None:
    """Return what the word means, None when it is neither a true nor a false word."""
    word = text.strip().lower()
    if word in TRUE_WORDS:
        return True
    return False if word in FALSE_WORDS else None


def truth_text(value: bool) -> str:
    """Return the word that ROS launch files compare with."""
    return "true" if value else "false"


def perform_truth(context: LaunchContext, value: bool | Text, name: str) -> bool:
    """Return a truth that may be given as a text.

    Args:
        context: the scope.
        value: what was given.
        name: what it is the value of, for the error.

    Raises:
        LaunchFileError: the text is neither a word for true nor one for false.
    """
    if isinstance(value, bool):
        return value
    text = perform_text(context, value)
    truth = parse_truth(text)
    if truth is None:
        raise LaunchFileError(f"{name} is {text!r}, neither true nor false")
    return truth
