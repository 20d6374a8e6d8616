"""The fixture arm_ros, as users have it: each test has a launch of its own."""

import os
import sys
from collections import Counter
from pathlib import Path

import pytest
from controller_manager_msgs.srv import ListControllers
from sensor_msgs.msg import Image, JointState

from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile
from arm_sim.errors import BenchError

pytestmark = pytest.mark.arm_ros(arguments={"camera": "none", "real_time_factor": 4})

GOAL = [1.0, 0.5, 0.1, 0.5]
CONTROLLER = "position_controller"
WITHIN_S = 40.0
"""Simulated, at four times real time: a busy machine may hold a command up."""
# Ctrl-C ends it at once: rclpy's own handlers turn one that comes while a message is converted into
# a RuntimeError, and the program would end with exit code 1.
LISTENER = """
import signal
import rclpy
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import JointState
rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
signal.signal(signal.SIGINT, signal.SIG_DFL)
node = rclpy.create_node("listener")
node.create_subscription(JointState, "joint_states", lambda m: print("heard", flush=True), 10)
rclpy.spin(node)
"""


def test_commands_states_and_the_users_own_nodes(arm_ros):
    assert os.environ["ROS_DOMAIN_ID"] == str(arm_ros.domain_id)
    own = arm_ros.run(sys.executable, "-c", LISTENER)
    arm_ros.command(CONTROLLER, GOAL)
    arm_ros.assert_reaches(GOAL, within_s=WITHIN_S, hold_s=0.2)
    arm_ros.assert_never_exceeds(velocity=2.1)
    with pytest.raises(AssertionError, match="j0: position"):
        arm_ros.assert_never_exceeds(position={"j0": 0.9})
    answer = arm_ros.call("/controller_manager/list_controllers", ListControllers)
    assert {c.name: c.state for c in answer.controller}[CONTROLLER] == "active"
    assert len(arm_ros.processes["arm_gazebo_node"]) == 1
    own.wait_for_line("heard", 30.0)


def test_faults_in_the_simulation(arm_ros):
    with arm_ros.faults.joint_stalled("j1"):
        arm_ros.command(CONTROLLER, GOAL)
        with pytest.raises(AssertionError, match="fault: j1 joint stalled"):
            arm_ros.assert_reaches(GOAL, within_s=1.0)
    arm_ros.assert_reaches(GOAL, within_s=WITHIN_S)
    with arm_ros.faults.sensor_frozen("j0"):
        arm_ros.command(CONTROLLER, [0.0] * 4)
        arm_ros.assert_reaches({"j1": 0.0, "j2": 0.0, "j3": 0.0}, within_s=WITHIN_S)
        arm_ros.assert_reaches({"j0": 1.0})
    arm_ros.assert_reaches([0.0] * 4, within_s=WITHIN_S)
    with (
        pytest.raises(BenchError, match="faults: no joint 'j9'; there are j0, j1, j2, j3"),
        arm_ros.faults.joint_stalled("j9"),
    ):
        pass
    with arm_ros.faults.controller_raises(CONTROLLER):
        arm_ros.wait_for_log(f"controller '{CONTROLLER}' raised in its update")


def test_faults_of_messages_and_processes(arm_ros):
    def twice(messages) -> int:
        stamps = Counter((m.header.stamp.sec, m.header.stamp.nanosec) for m in messages)
        return list(stamps.values()).count(2)

    relayed = arm_ros.collect("/relayed", JointState)
    with arm_ros.faults.messages_doubled("/joint_states", to="/relayed", after_s=0.01):
        relayed.wait_until(lambda m: twice(m) >= 100, "100 messages that come twice")

    arm_ros.collect("/pictures", Image)
    seen = arm_ros.collect("/dark", Image)
    with arm_ros.faults.camera_dark("/pictures", to="/dark"):
        arm_ros.publish("/pictures", Image(width=2, data=b"\x07" * 6))
        (dark,) = seen.wait_for(1)
    assert dark.width == 2
    assert bytes(dark.data) == bytes(6)

    with arm_ros.faults.process_stopped("arm_gazebo_node"):
        # What was under way arrives; then nothing comes any more.
        arm_ros.collect("/joint_states", JointState)
        with pytest.raises(BenchError, match="timed out after 1 s"):
            arm_ros.collect("/joint_states", JointState).wait_for(100_000, timeout_s=1.0)
        before = len(arm_ros.history)
    assert arm_ros.run_until(lambda: len(arm_ros.history) > before, timeout_s=60.0)

    with arm_ros.faults.process_killed("robot_state_publisher"):
        arm_ros.wait_for_log(r"robot_state_publisher.* was killed by SIGKILL")
    with (
        pytest.raises(BenchError, match=r"no program 'nobody'; it has .*arm_gazebo_node"),
        arm_ros.faults.process_killed("nobody"),
    ):
        pass


@pytest.mark.arm_ros(robot="mycobot", arguments={"use_camera": False})
def test_goals(arm_ros):
    joints = ["link1_to_link2", "link2_to_link3", "link3_to_link4"]
    joints += ["link4_to_link5", "link5_to_link6", "link6_to_link6_flange"]
    trajectory = {"times_s": [1.0], "positions": [[0.3] * 6], "joints": joints}
    arm_ros.follow("arm_controller", trajectory)
    arm_ros.assert_reaches(dict.fromkeys(joints, 0.3), tolerance=0.05, within_s=WITHIN_S)
    arm_ros.grip("gripper_action_controller", -0.3)
    arm_ros.assert_reaches({"gripper_controller": -0.3}, tolerance=0.05, within_s=WITHIN_S)


def test_a_failing_test_has_the_launchs_log_and_a_plot(pytester):
    pytester.makepyfile(
        """
import pytest

@pytest.mark.arm_ros(arguments={"camera": "none", "real_time_factor": 0})
def test_fails(arm_ros):
    arm_ros.assert_reaches([1.0] * 4, within_s=0.5)

@pytest.mark.arm_ros(world="nowhere")
def test_cannot_start(arm_ros):
    pass
"""
    )
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider")
    result.assert_outcomes(failed=1, errors=1)
    result.stdout.fnmatch_lines(
        [
            "*no world 'nowhere'*",
            "E*AssertionError: the joints do not reach the target within 0.5 s",
            "*- arm -*",
            "joints: *joints.png",
            "run it again: arm sim replay *test.run",
            "log: *launch.log",
            "*arm_gazebo_node is ready after*",
        ]
    )
    (log,) = Path(pytester.path, "arm-artifacts").rglob("launch.log")
    assert "ready " in log.read_text()
    (recording,) = Path(pytester.path, "arm-artifacts").rglob("test.run")
    replayed = Replay(RunFile(recording)).run()
    assert replayed.difference is None
    assert replayed.periods > 0
