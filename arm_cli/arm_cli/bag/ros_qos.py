"""Converts quality of service between rclpy and bags."""

from collections.abc import Iterable, Sequence

from rclpy.duration import Duration
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from rclpy.topic_endpoint_info import TopicEndpointInfo

from arm_cli.bag.offered_qos import OfferedQos, QosDuration
from arm_cli.ros.qos import matching_profile

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
    """Return the strictest profile of a subscription that matches all publishers.

    Args:
        publishers: the publishers of the topic.
        override: the user's QoS, which replaces the matching one.
    """
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
