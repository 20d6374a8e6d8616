"""Quality of service of a recorder's subscriptions and a player's publishers."""

from rclpy.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy

from arm_cli.bag.offered_qos import OfferedQos
from arm_cli.ros.bag_qos import RECORDING_DEPTH, playing_profile, recording_profile


def test_different_offers_become_the_stronger_one_each():
    profile = playing_profile(
        [
            OfferedQos(depth=3, reliability="best_effort", durability="transient_local"),
            OfferedQos(depth=20),
        ]
    )
    assert profile.reliability == ReliabilityPolicy.RELIABLE
    assert profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
    assert (profile.history, profile.depth) == (HistoryPolicy.KEEP_LAST, 20)


def test_an_override_holds_whatever_is_offered():
    weak = OfferedQos(reliability="best_effort", depth=1)
    profile = recording_profile([], weak)
    assert profile.reliability == ReliabilityPolicy.BEST_EFFORT
    assert profile.depth == RECORDING_DEPTH
    latched = recording_profile([], OfferedQos(durability="transient_local"))
    assert latched.durability == DurabilityPolicy.TRANSIENT_LOCAL
    assert latched.reliability == ReliabilityPolicy.RELIABLE


def test_all_is_kept_where_that_is_wanted():
    assert playing_profile([OfferedQos(history="keep_all")]).history == HistoryPolicy.KEEP_ALL
