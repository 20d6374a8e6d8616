"""What the page says when nothing comes any more."""

import math
from types import MappingProxyType

from arm_viewer.simulation_watch import GONE, WAITING, complaint
from arm_viewer.snapshot import Description, JointStates, Snapshot, Topic

DESCRIPTIONS = MappingProxyType({"/robot_description": Description("/robot_description", "", None)})


def snapshot(received_s, publishers):
    states = JointStates(MappingProxyType({}), received_s)
    return Snapshot(
        made_s=100.0,
        descriptions=DESCRIPTIONS,
        joint_states=MappingProxyType({"/joint_states": states}),
        topics=(Topic("/joint_states", ("sensor_msgs/msg/JointState",), publishers, 0, math.nan),),
    )


def test_without_a_robot_it_waits():
    assert complaint(Snapshot()) == WAITING


def test_all_is_well_while_joint_states_come():
    assert complaint(snapshot(99.5, 1)) == ""


def test_the_simulation_went_away_when_nobody_publishes():
    assert complaint(snapshot(90.0, 0)) == GONE


def test_a_simulation_that_is_there_but_silent_is_told_apart():
    assert "/joint_states for 10 s" in complaint(snapshot(90.0, 1))
