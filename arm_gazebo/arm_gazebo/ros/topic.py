"""Quality of service, subscriber checks, stamps and message types of topics."""

from collections.abc import Sequence
from importlib import import_module
from typing import Any

from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from std_msgs.msg import Header

QOS = QoSProfile(depth=2)
"""Reliable and volatile, so that both default and best-effort subscribers match."""
NS_PER_S = 1_000_000_000


def watched(publishers: Sequence[Publisher]) -> list[Publisher]:
    """Return the publishers that have subscribers now; takes about 1 us each."""
    return [p for p in publishers if p.get_subscription_count()]


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
