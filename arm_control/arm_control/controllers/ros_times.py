"""Converts times and durations to messages and back."""

from builtin_interfaces.msg import Duration, Time

SHORTEST_S, LONGEST_S = -(2.0**31), 2.0**31 - 1.0
"""The range of a Duration message."""


def seconds_of(time: Time | Duration) -> float:
    """Return a stamp or a duration in seconds; exact to 1 ns up to some months."""
    return time.sec + time.nanosec * 1e-9


def duration_parts(time_s: float) -> tuple[int, int]:
    """Return seconds and nanoseconds of a Duration, clamped to its range."""
    nanoseconds = round(min(max(time_s, SHORTEST_S), LONGEST_S) * 1e9)
    return divmod(nanoseconds, 1_000_000_000)


def duration_message(time_s: float) -> Duration:
    """Return a duration as a message, clamped to its range."""
    seconds, nanoseconds = duration_parts(time_s)
    return Duration(sec=seconds, nanosec=nanoseconds)


def time_message(time_s: float) -> Time:
    """Return a time as a stamp."""
    seconds, nanoseconds = divmod(round(time_s * 1e9), 1_000_000_000)
    return Time(sec=seconds, nanosec=nanoseconds)
