"""The node, against a real launch: some seconds per test."""

import sys

import pytest

pytestmark = pytest.mark.arm_ros(arguments={"camera": "none", "real_time_factor": 4})

NODE = (sys.executable, "-m", "patrol.node")
TIMEOUT_S = 60.0


def test_the_arm_patrols(arm_ros):
    node = arm_ros.run(*NODE)
    node.wait_for_line("pose 2 reached", TIMEOUT_S)
    arm_ros.assert_never_exceeds(velocity=2.1)


def test_half_of_the_joint_states_are_enough(arm_ros):
    node = arm_ros.run(*NODE, "--ros-args", "-r", "/joint_states:=/lossy/joint_states")
    with arm_ros.faults.messages_dropped(
        "/joint_states", to="/lossy/joint_states", fraction=0.5, seed=1
    ):
        assert node.wait_for_line("pose 2 reached", TIMEOUT_S)


def test_a_stuck_joint_is_reported(arm_ros):
    with arm_ros.faults.joint_stalled("j1"):
        node = arm_ros.run(*NODE)
        assert node.wait_for_line("the arm is stuck", TIMEOUT_S)
    assert node.wait_for_line("pose 1 reached", TIMEOUT_S)
