"""Connects Python's logging to ROS: the records of its loggers, and services about their levels.

Core modules only use `logging.getLogger(__name__)`.
"""

import logging
from collections.abc import Iterator
from contextlib import contextmanager

from rcl_interfaces.msg import LoggerLevel, SetLoggerLevelsResult
from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.logging import get_logger_level, set_logger_level
from rclpy.node import Node

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


_UNSET = 0


class LoggerLevelServices:
    """Serves the levels of all loggers of the process as long as the node exists.

    The levels of ROS (10 for DEBUG to 50 for FATAL) are those of Python's logging.
    """

    def __init__(self, node: Node) -> None:
        """Add the services to a node that is not yet in an executor."""
        self._logger_of_node = node.get_logger().name
        self._name_of_node = node.get_name()
        node.create_service(GetLoggerLevels, "~/get_logger_levels", self._get)
        node.create_service(SetLoggerLevels, "~/set_logger_levels", self._set)

    def _get(
        self, request: GetLoggerLevels.Request, response: GetLoggerLevels.Response
    ) -> GetLoggerLevels.Response:
        response.levels = [LoggerLevel(name=name, level=_level_of(name)) for name in request.names]
        return response

    def _set(
        self, request: SetLoggerLevels.Request, response: SetLoggerLevels.Response
    ) -> SetLoggerLevels.Response:
        response.results = [self._set_one(wanted.name, wanted.level) for wanted in request.levels]
        return response

    def _set_one(self, name: str, level: int) -> SetLoggerLevelsResult:
        # The core logs under the node's name without its namespace.
        names = {name, self._name_of_node} if name == self._logger_of_node else {name}
        try:
            for each in names:
                set_logger_level(each, level, detailed_error=True)
        except (ValueError, RuntimeError):
            return SetLoggerLevelsResult(
                reason=f"no logger can have the level {level}; the levels are 10 (DEBUG), "
                "20 (INFO), 30 (WARN), 40 (ERROR), 50 (FATAL) and 0 (the parent logger's)"
            )
        for each in names:
            logging.getLogger(each).setLevel(level)
        return SetLoggerLevelsResult(successful=True)


def _level_of(name: str) -> int:
    """Return the level of a logger, 0 if none was set."""
    try:
        return int(get_logger_level(name))
    except RuntimeError:
        return _UNSET
