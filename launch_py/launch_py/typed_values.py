"""Booleans and durations that a launch file may give as text."""

from __future__ import annotations

from launch_py.errors import LaunchFileError
from launch_py.substitution import LaunchScope, Text, perform_text

TRUE_WORDS = ("true", "1", "yes", "on")
FALSE_WORDS = ("false", "0", "no", "off")


def parse_boolean(text: str) -> bool | None:
    """Return the boolean that a word means, or None if it is not a boolean."""
    word = text.strip().lower()
    if word in TRUE_WORDS:
        return True
    return False if word in FALSE_WORDS else None


def boolean_text(value: bool) -> str:
    """Return "true" or "false", as ROS launch files spell them."""
    return "true" if value else "false"


def perform_boolean(context: LaunchScope, value: bool | Text, name: str) -> bool:
    """Return a boolean that may be given as a text.

    Raises:
        LaunchFileError: the text means neither true nor false.
    """
    if isinstance(value, bool):
        return value
    text = perform_text(context, value)
    truth = parse_boolean(text)
    if truth is None:
        raise LaunchFileError(f"{name} is {text!r}, neither true nor false")
    return truth


def check_seconds(value: object, name: str) -> float:
    """Return a duration in s; infinity means never.

    Raises:
        LaunchFileError: the value is not a number, or is negative.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not value >= 0.0:
        raise LaunchFileError(f"{name} is {value!r}, not a number of seconds")
    return float(value)


def perform_seconds(context: LaunchScope, value: float | Text, name: str) -> float:
    """Return a duration in s that may be given as a text.

    Raises:
        LaunchFileError: as `check_seconds`.
    """
    if isinstance(value, int | float):
        return check_seconds(value, name)
    text = perform_text(context, value)
    try:
        return check_seconds(float(text), name)
    except ValueError:
        raise LaunchFileError(f"{name} is {text!r}, not a number of seconds") from None
