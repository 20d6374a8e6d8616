"""QoS profiles of publishers and subscriptions: as requested, as matches, as recorded."""

import copy
from collections.abc import Iterable, Sequence

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

from arm_cli.bag_format.offered_qos import OfferedQos, QosDuration
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


RECORDING_DEPTH = 5000
"""Ten seconds of a fast topic, in case the recorder stalls. Memory is allocated as needed."""
PLAYING_DEPTH = 10
"""The minimum depth of a player's publisher, as in rosbag2."""
UNLIMITED = Duration()
"""Zero means "no limit" in rclpy."""


def offered_qos(publisher: TopicEndpointInfo) -> OfferedQos:
    """Return the QoS that a publisher offers."""
    profile = publisher.qos_profile
    return OfferedQos(
        history=profile.history.short_key,
        depth=profile.depth,
        reliability=profile.reliability.short_key,
        durability=profile.durability.short_key,
        deadline=_recorded(profile.deadline),
        lifespan=_recorded(profile.lifespan),
        liveliness=profile.liveliness.short_key,
        lease=_recorded(profile.liveliness_lease_duration),
        avoid_ros_namespace_conventions=profile.avoid_ros_namespace_conventions,
    )


def recording_profile(
    publishers: Sequence[TopicEndpointInfo], override: OfferedQos | None = None
) -> QoSProfile:
    """Return the strictest profile of a subscription that matches all publishers, or the user's."""
    profile = matching_profile(publishers) if override is None else playing_profile([override])
    profile.depth = RECORDING_DEPTH
    return profile


def playing_profile(offers: Sequence[OfferedQos]) -> QoSProfile:
    """Return a publisher's profile that matches every subscription of the recorded publishers.

    For one offer, or several equal ones, it is that offer. For different offers it takes the
    stronger policy of each kind, which matches every subscription that the weaker one matches.
    """
    depth = max([PLAYING_DEPTH, *(offer.depth for offer in offers)])
    profile = QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=depth)
    if not offers:
        return profile
    if any(offer.history == "keep_all" for offer in offers):
        profile.history = HistoryPolicy.KEEP_ALL
    reliable = any(offer.reliability != "best_effort" for offer in offers)
    latched = any(offer.durability == "transient_local" for offer in offers)
    profile.reliability = ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT
    profile.durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
    if any(offer.liveliness == "manual_by_topic" for offer in offers):
        profile.liveliness = LivelinessPolicy.MANUAL_BY_TOPIC
    profile.deadline = _shortest([offer.deadline for offer in offers])
    profile.liveliness_lease_duration = _shortest([offer.lease for offer in offers])
    lifespans_ns = [offer.lifespan.limit_ns for offer in offers]
    limits_ns = [limit_ns for limit_ns in lifespans_ns if limit_ns is not None]
    unlimited = len(limits_ns) < len(offers)
    profile.lifespan = UNLIMITED if unlimited else Duration(nanoseconds=max(limits_ns))
    return profile


def _recorded(duration: Duration) -> QosDuration:
    return QosDuration(*divmod(duration.nanoseconds, 10**9))


def _shortest(durations: Iterable[QosDuration]) -> Duration:
    limits_ns = [one.limit_ns for one in durations if one.limit_ns is not None]
    return Duration(nanoseconds=min(limits_ns)) if limits_ns else UNLIMITED
