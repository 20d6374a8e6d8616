"""Fixtures that tests of several packages share."""

import os
import sys

import pytest

DOMAIN_IDS = 101
"""ROS domain ids 1 to 101 have ports that no operating system hands out by itself."""


def pytest_configure(config: pytest.Config) -> None:
    """Give the whole session a ROS domain of its own, before anything imports rclpy."""
    os.environ.setdefault("ROS_DOMAIN_ID", str(1 + os.getpid() % DOMAIN_IDS))
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ.setdefault("ROS_PYTHON_CHECK_FIELDS", "1")
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    if sys.prefix not in prefixes:
        os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join([sys.prefix, *filter(None, prefixes)])
