"""Times that a launch file gives."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launch_py.errors import LaunchFileError
from launch_py.substitution import Text, perform_text

if TYPE_CHECKING:
    from launch_py.launch_context import LaunchContext


def check_seconds(value: object, name: str) -> float:
    """Return a time in s, which may be infinite: never.

    Args:
        value: what was given.
        name: what it is the time of, for the error.

    Raises:
        LaunchFileError: it is no number, or a negative one.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not value >= 0.0:
        raise LaunchFileError(f"{name} is {value!r}, not seconds")
    return float(value)


def perform_seconds(context: LaunchContext, value: float | Text, name: str) -> float:
    """Return a time in s that may be given as a text.

    Raises:
        LaunchFileError: as `check_seconds`.
    """
    if isinstance(value, int | float):
        return check_seconds(value, name)
    text = perform_text(context, value)
    try:
        return check_seconds(float(text), name)
    except ValueError:
        raise LaunchFileError(f"{name} is {text!r}, not seconds") from None
