"""What the topics of all pictures have in common."""

from collections.abc import Sequence

from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from std_msgs.msg import Header

QOS = QoSProfile(depth=2)
"""Reliable and volatile: default and best-effort subscribers both match."""
NS_PER_S = 1_000_000_000


def watched(publishers: Sequence[Publisher]) -> list[Publisher]:
    """Return the publishers that somebody subscribes to now; about 1 us each."""
    return [p for p in publishers if p.get_subscription_count()]


def set_stamp(header: Header, time_s: float) -> None:
    """Stamp a header with a simulation time."""
    header.stamp.sec, header.stamp.nanosec = divmod(round(time_s * NS_PER_S), NS_PER_S)
