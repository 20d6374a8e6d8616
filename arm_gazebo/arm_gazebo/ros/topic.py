"""Stamps and message types of topics."""

from importlib import import_module
from typing import Any

from std_msgs.msg import Header

NS_PER_S = 1_000_000_000


def set_stamp(header: Header, time_s: float) -> None:
    """Stamp a header with a simulation time."""
    header.stamp.sec, header.stamp.nanosec = divmod(round(time_s * NS_PER_S), NS_PER_S)


def message_class(type_name: str) -> Any:
    """Return the class of a type such as 'std_msgs/msg/Header'.

    Raises:
        ImportError, AttributeError, ValueError: there is no such message, or it is not installed.
    """
    package, name = type_name.split("/msg/")
    return getattr(import_module(f"{package}.msg"), name)
