"""QoS profiles of a command's publishers and subscriptions."""

import copy
from collections.abc import Sequence

from rclpy.duration import Duration
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)
from rclpy.topic_endpoint_info import TopicEndpointInfo

from arm_cli.qos_options import QosChoice

MEASURING = QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT)
"""Matches every publisher, and has room for messages while the terminal is slow."""


def qos_profile(choice: QosChoice, preset: str) -> QoSProfile:
    """Return the profile of a choice; without a profile it starts from `preset`."""
    profile = copy.copy(QoSPresetProfiles.get_from_short_key(choice.profile or preset))
    if choice.history:
        profile.history = HistoryPolicy.get_from_short_key(choice.history)
    if choice.reliability:
        profile.reliability = ReliabilityPolicy.get_from_short_key(choice.reliability)
    if choice.durability:
        profile.durability = DurabilityPolicy.get_from_short_key(choice.durability)
    if choice.liveliness:
        profile.liveliness = LivelinessPolicy.get_from_short_key(choice.liveliness)
    if choice.lease_s is not None:
        profile.liveliness_lease_duration = Duration(seconds=choice.lease_s)
    if choice.depth is not None:
        profile.depth = choice.depth
    elif profile.durability == DurabilityPolicy.TRANSIENT_LOCAL and profile.depth == 0:
        profile.depth = 1
    return profile


def matching_profile(publishers: Sequence[TopicEndpointInfo]) -> QoSProfile:
    """Return the strictest profile of a subscription that matches all publishers."""
    profile = copy.copy(QoSPresetProfiles.get_from_short_key("sensor_data"))
    offers = [info.qos_profile for info in publishers]
    if offers and all(o.reliability == ReliabilityPolicy.RELIABLE for o in offers):
        profile.reliability = ReliabilityPolicy.RELIABLE
    if offers and all(o.durability == DurabilityPolicy.TRANSIENT_LOCAL for o in offers):
        profile.durability = DurabilityPolicy.TRANSIENT_LOCAL
    return profile
