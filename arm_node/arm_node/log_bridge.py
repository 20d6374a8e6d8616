"""Passes records of Python's logging to ROS: to the console, the log file and /rosout.

Core modules only use `logging.getLogger(__name__)`.
"""

import logging
from collections.abc import Iterator
from contextlib import contextmanager

from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.impl.logging_severity import LoggingSeverity

from arm_node.printable import printable, printable_message

_SEVERITIES = (
    LoggingSeverity.FATAL,
    LoggingSeverity.ERROR,
    LoggingSeverity.WARN,
    LoggingSeverity.INFO,
)


class RosLogHandler(logging.Handler):
    """Writes each record with its own name and source location; any thread.

    It calls rcutils directly: rclpy's logger searches the stack and all modules for the calling
    line, which takes longer than logging itself (10 ms or more at the start). The record already
    has that line.
    """

    def emit(self, record: logging.LogRecord) -> None:
        """Write one record; ROS filters by its own level."""
        severity = next((s for s in _SEVERITIES if record.levelno >= s), LoggingSeverity.DEBUG)
        if rclpy_implementation.rclpy_logging_logger_is_enabled_for(record.name, severity):
            rclpy_implementation.rclpy_logging_rcutils_log(
                severity,
                record.name,
                _message(record),
                record.funcName or "",
                record.pathname,
                record.lineno,
            )


def _message(record: logging.LogRecord) -> str:
    """Return the text to log, with newlines and control characters from outside escaped."""
    message = printable_message(record.getMessage())
    if not record.exc_info:
        return message
    traceback = logging.Formatter().formatException(record.exc_info)
    return "\n  ".join([message, *map(printable, traceback.split("\n"))])


@contextmanager
def bridge_logging() -> Iterator[None]:
    """Route Python's root logger to ROS while the context lasts."""
    root = logging.getLogger()
    handler = RosLogHandler()
    previous_level = root.level
    root.addHandler(handler)
    root.setLevel(logging.INFO)
    try:
        yield
    finally:
        root.removeHandler(handler)
        root.setLevel(previous_level)
