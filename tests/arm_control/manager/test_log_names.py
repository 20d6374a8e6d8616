"""Log lines of the controller manager come from ROS's logger of that name."""

import importlib
import pkgutil

import pytest

import arm_control.loop
import arm_control.manager

MODULES = [
    module.name
    for package in (arm_control.manager, arm_control.loop)
    for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
    if not module.ispkg
]


@pytest.mark.parametrize("name", MODULES)
def test_a_module_of_the_manager_logs_as_the_manager(name):
    logger = getattr(importlib.import_module(name), "logger", None)
    assert logger is None or logger.name == "controller_manager"
