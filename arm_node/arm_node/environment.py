"""The process environment that rclpy from pip needs, set by the process itself."""

import importlib.util
import os
import sys
import tempfile
from collections.abc import MutableMapping
from pathlib import Path

INTERFACE_PACKAGES = (
    "tf2_msgs",
    "control_msgs",
    "controller_manager_msgs",
    "simulation_interfaces",
)
"""Interface packages that the rclpy wheels lack and the distribution arm-interfaces brings."""


class MissingInterfacesError(Exception):
    """An interface package that the nodes need is not installed; the message says the fix."""


def prepare_environment(environ: MutableMapping[str, str] = os.environ) -> None:
    """Make rclpy usable in this process, whoever started it.

    Must run before rclpy is imported. Adds this Python's prefix to AMENT_PREFIX_PATH (the wheels
    do not set it and ament_index then refuses every look-up), and gives ROS_LOG_DIR a value where
    the process has no HOME (rclpy would refuse to start).

    Raises:
        MissingInterfacesError: an interface package of arm-interfaces is not installed.
    """
    prefixes = [p for p in environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
    if sys.prefix not in prefixes:
        environ["AMENT_PREFIX_PATH"] = os.pathsep.join([*prefixes, sys.prefix])
    if "HOME" not in environ and "ROS_LOG_DIR" not in environ and "ROS_HOME" not in environ:
        environ["ROS_LOG_DIR"] = str(Path(tempfile.gettempdir()) / f"ros-log-{os.getuid()}")
    missing = [name for name in INTERFACE_PACKAGES if importlib.util.find_spec(name) is None]
    if missing:
        raise MissingInterfacesError(
            f"the ROS interface package{'s' if len(missing) > 1 else ''} {', '.join(missing)} "
            f"{'are' if len(missing) > 1 else 'is'} not installed for {sys.executable}; "
            "run 'pip install ./arm_interfaces' from the arm suite's folder, "
            "or source a ROS 2 Jazzy that has them"
        )
