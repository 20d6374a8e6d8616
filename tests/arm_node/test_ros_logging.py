"""The services that set the level of a logger, called without a middleware."""

import logging
from typing import Any

import pytest


class FakeNode:
    """Keeps the callbacks of its services."""

    def __init__(self, name: str, logger_name: str) -> None:
        self._name, self._logger_name = name, logger_name
        self.callbacks: dict[str, Any] = {}

    def get_name(self) -> str:
        return self._name

    def get_logger(self) -> Any:
        from rclpy.logging import get_logger

        return get_logger(self._logger_name)

    def create_service(self, type_: Any, name: str, callback: Any) -> None:
        self.callbacks[name] = lambda request: callback(request, type_.Response())


def set_level(node: FakeNode, name: str, level: int) -> Any:
    from rcl_interfaces.msg import LoggerLevel
    from rcl_interfaces.srv import SetLoggerLevels

    request = SetLoggerLevels.Request(levels=[LoggerLevel(name=name, level=level)])
    (result,) = node.callbacks["~/set_logger_levels"](request).results
    return result


def get_level(node: FakeNode, name: str) -> int:
    from rcl_interfaces.srv import GetLoggerLevels

    (level,) = node.callbacks["~/get_logger_levels"](GetLoggerLevels.Request(names=[name])).levels
    return level.level


@pytest.fixture
def node() -> FakeNode:
    from arm_node.ros_logging import LoggerLevelServices

    node = FakeNode("levels_controller", "left.levels_controller")
    LoggerLevelServices(node)
    return node


@pytest.mark.parametrize("name", ["levels_controller", "left.levels_controller"])
def test_what_a_node_logs_through_python_follows_its_level(node, name, capfd):
    from arm_node.ros_logging import bridge_logging

    core = logging.getLogger("levels_controller")
    with bridge_logging():
        core.debug("below the level of all")
        assert set_level(node, name, logging.DEBUG).successful
        core.debug("asked for by %s", name)
        assert set_level(node, name, logging.ERROR).successful
        core.warning("too mild")
        core.error("bad enough")
        assert get_level(node, name) == logging.ERROR
        assert set_level(node, name, 0).successful
        core.info("as mild as any")
    printed = "".join(capfd.readouterr())
    assert f"asked for by {name}" in printed
    assert "bad enough" in printed
    assert "as mild as any" in printed
    assert "below the level" not in printed
    assert "too mild" not in printed


def test_a_level_that_there_is_not_is_refused_with_those_there_are(node):
    result = set_level(node, "levels_controller", 77)
    assert not result.successful
    assert result.reason.startswith("no logger can have the level 77; the levels are 10 (DEBUG)")


def test_a_logger_without_a_level_reports_0(node):
    assert get_level(node, "nobody_knows_it") == 0
