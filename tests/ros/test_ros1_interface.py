"""The arm as it was in ROS 1: a controller for each joint, everything under /arm."""

import signal

import numpy as np
import pytest

pytestmark = pytest.mark.ros

TYPE = "position_controllers/JointPositionController"
ORIGINAL_POSE = [-5.0, 0.5, -1.2, -1.0]
LIMIT = -2.57


def is_at(message, pose):
    positions = dict(zip(message.name, message.position, strict=True))
    return np.allclose([positions[f"j{i}"] for i in range(4)], pose, atol=0.01)


def test_four_topics_move_the_arm_and_states_come_at_50_hz(launch, client):
    from sensor_msgs.msg import JointState
    from std_msgs.msg import Float64

    # In two steps, as the original is started.
    world = launch("arm_gazebo", "arm_world.launch.py", "interface:=ros1", "camera:=none")
    world.wait_until_ready()
    assert launch("arm_control", "arm_control.launch.py", "interface:=ros1").wait() == 0
    states = client.subscribe(JointState, "/arm/joint_states")
    pose = [0.3, 0.2, -0.4, 0.5]
    for index, position in enumerate(pose):
        topic = f"/arm/j{index}p_controller/command"
        client.publisher(Float64, topic).publish(Float64(data=position))
    states.wait_until(lambda m: bool(m) and is_at(m[-1], pose), "the arm is there")

    states.clear()
    stamps = [m.header.stamp.sec + m.header.stamp.nanosec * 1e-9 for m in states.wait_for(50)]
    # A subscription may miss one on a busy machine.
    periods = np.rint(np.diff(stamps) / 0.02)
    assert np.allclose(np.diff(stamps), 0.02 * periods)
    assert periods.min() == 1


def test_the_originals_node_goes_beyond_a_limit_and_is_warned_once(launch, client):
    from controller_manager_msgs.srv import ListControllers
    from sensor_msgs.msg import JointState

    simulation = launch("interface:=ros1", "camera:=none")
    simulation.wait_until_ready()
    listed = client.call(
        ListControllers, "/arm/controller_manager/list_controllers", ListControllers.Request()
    )
    assert {c.name: c.state for c in listed.controller if c.type == TYPE} == {
        f"j{i}p_controller": "active" for i in range(4)
    }

    states = client.subscribe(JointState, "/arm/joint_states")
    node = launch("arm_controller", "arm_controller_node.launch.py", "interface:=ros1")
    node.wait_for_line("Publishing positions: [-5.000000, 0.500000, -1.200000, -1.000000]")
    states.wait_until(
        lambda m: bool(m) and is_at(m[-1], [LIMIT, *ORIGINAL_POSE[1:]]), "the arm is folded"
    )
    node.wait_for_line("Joint State: 'j0' Position: -2.57")
    assert node.stop(signal.SIGINT) == 0
    assert simulation.stop(signal.SIGINT) == 0
    warning = "joint 'j0': position command -5 rad is beyond its limit of -2.57 rad"
    assert simulation.output.count(warning) == 1
