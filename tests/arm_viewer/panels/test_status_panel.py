"""The page's messages when data stop arriving."""

import math
from dataclasses import replace
from types import MappingProxyType

from arm_viewer.panels.status_panel import GONE, NO_ROBOT, WAITING, status_message
from arm_viewer.snapshot import Description, JointStates, RunStatus, Snapshot, Topic

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
    assert status_message(Snapshot()) == WAITING


def test_a_recording_waits_for_nothing():
    assert status_message(Snapshot(replay="bag")) == NO_ROBOT
    recorded = snapshot(received_s=0.0, publishers=1)
    assert status_message(replace(recorded, made_s=60.0, replay="bag")) == ""


def test_all_is_well_while_joint_states_come():
    assert status_message(snapshot(99.5, 1)) == ""


def test_the_simulation_has_ended_with_the_last_robot():
    lost = frozenset({"/robot_description", "/joint_states"})
    assert status_message(Snapshot(lost=lost)) == GONE


def test_joint_states_that_are_no_longer_published_are_named():
    said = status_message(replace(snapshot(99.5, 1), lost=frozenset({"/joint_states"})))
    assert said.startswith("/joint_states is no longer published")


def test_a_present_but_silent_simulation_is_distinguished():
    assert "/joint_states for 10 s" in status_message(snapshot(90.0, 1))


def test_a_paused_simulation_is_silent_and_nothing_is_wrong():
    paused = replace(snapshot(90.0, 1), run=RunStatus("paused", 1.0, ()))
    assert status_message(paused) == ""
    assert status_message(replace(paused, run=RunStatus("playing", 1.0, ())))
