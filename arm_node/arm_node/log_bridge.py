"""Carries records of Python's logging to rclpy's logger, so to the console, the file and /rosout.

Core modules know only `logging.getLogger(__name__)`; this is where ROS comes in.
"""

import logging
from collections.abc import Iterator
from contextlib import contextmanager

from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.logging import get_logger


class RosLogHandler(logging.Handler):
    """Writes each record through the rclpy logger of the record's name, any thread."""

    def __init__(self) -> None:
        super().__init__()
        self._loggers: dict[str, RcutilsLogger] = {}

    def emit(self, record: logging.LogRecord) -> None:
        """Write one record; rclpy filters by its own level."""
        logger = self._loggers.get(record.name)
        if logger is None:
            logger = self._loggers[record.name] = get_logger(record.name)
        message = self.format(record)
        # rclpy remembers the severity of each calling line, so each level has a line of its own.
        if record.levelno >= logging.CRITICAL:
            logger.fatal(message)
        elif record.levelno >= logging.ERROR:
            logger.error(message)
        elif record.levelno >= logging.WARNING:
            logger.warning(message)
        elif record.levelno >= logging.INFO:
            logger.info(message)
        else:
            logger.debug(message)


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
