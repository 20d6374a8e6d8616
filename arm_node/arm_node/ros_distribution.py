"""Which ROS 2 distribution rclpy is from."""

from arm_node.workarounds.switch import RCLPY

DEFAULT = "jazzy"
"""The distribution whose wheels pip installs unless ROS_DISTRO names another."""
_BY_VERSION = {"7.": "jazzy", "9.": "kilted"}


def ros_distribution() -> str:
    """Return the name of the distribution of the rclpy in use; `DEFAULT` if it is not known."""
    version = RCLPY.find_version() or ""
    return next((_BY_VERSION[one] for one in _BY_VERSION if version.startswith(one)), DEFAULT)
