"""The services ~/get_logger_levels and ~/set_logger_levels of a node that logs through Python.

rclpy's own services only set the level of ROS loggers, which records below INFO do not reach.
"""

import logging

from rcl_interfaces.msg import LoggerLevel, SetLoggerLevelsResult
from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from rclpy.logging import get_logger_level, set_logger_level
from rclpy.node import Node

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
