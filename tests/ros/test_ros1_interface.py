"""The arm as it was in ROS 1: a controller for each joint, everything under /arm."""

import signal
import sys

import numpy as np
import pytest
from controller_manager_msgs.srv import ListControllers
from programs import RosProgram
from sensor_msgs.msg import CameraInfo, Image, JointState
from std_msgs.msg import Float64

TYPE = "position_controllers/JointPositionController"
ORIGINAL_POSE = [-5.0, 0.5, -1.2, -1.0]
LIMIT = -2.57


def is_at(message, pose):
    positions = dict(zip(message.name, message.position, strict=True))
    return np.allclose([positions[f"j{i}"] for i in range(4)], pose, atol=0.01)


def test_four_topics_move_the_arm_and_states_come_at_50_hz_beside_the_camera(launch, client):
    # In two steps, as the original is started.
    world = launch("arm_gazebo", "arm_world.launch.py", "interface:=ros1")
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

    (image, *_) = client.subscribe(Image, "/camera/image_raw").wait_for(1)
    assert (image.width, image.height) == (800, 800)
    (info, *_) = client.subscribe(CameraInfo, "/camera/camera_info").wait_for(1)
    assert (info.width, info.height) == (800, 800)
    assert info.k[0] == pytest.approx(400.0 / np.tan(1.3962634 / 2.0))


def list_controllers() -> tuple[int, list[str]]:
    """Return the exit code of the verb, and the lines that it prints."""
    verb = RosProgram([sys.executable, "-m", "arm_cli", "control", "list_controllers"])
    code = verb.wait()
    verb.close()
    return code, verb.own_words


@pytest.fixture(scope="class")
def simulation(launch_for_class):
    """The arm of ROS 1 with its controllers; the last of its tests ends it."""
    launched = launch_for_class("interface:=ros1", "camera:=none")
    launched.wait_until_ready()
    return launched


@pytest.mark.usefixtures("simulation")
class TestOneLaunch:
    def test_arm_control_finds_the_manager_of_ros_1_by_itself(self):
        code, lines = list_controllers()
        assert code == 0
        assert "j0p_controller" in "\n".join(lines)
        assert "there is no /controller_manager: asking /arm/controller_manager" in lines

    def test_the_original_s_node_exceeds_a_limit_and_gets_one_warning(
        self, launch, client, simulation
    ):
        listed = client.call(
            ListControllers, "/arm/controller_manager/list_controllers", ListControllers.Request()
        )
        assert {c.name: c.state for c in listed.controller if c.type == TYPE} == {
            f"j{i}p_controller": "active" for i in range(4)
        }

        states = client.subscribe(JointState, "/arm/joint_states")
        node = launch(
            *("arm_controller", "arm_controller_node.launch.py"), "interface:=ros1", "replace:=true"
        )
        node.wait_for_line("Publishing positions: [-5.000000, 0.500000, -1.200000, -1.000000]")
        states.wait_until(
            lambda m: bool(m) and is_at(m[-1], [LIMIT, *ORIGINAL_POSE[1:]]), "the arm is folded"
        )
        node.wait_for_line("Joint State: 'j0' Position: -2.57")
        assert node.stop(signal.SIGINT) == 0
        assert simulation.stop(signal.SIGINT) == 0
        warning = "joint 'j0': position command -5 rad is beyond its limit of -2.57 rad"
        assert simulation.output.count(warning) == 1


def test_several_managers_are_named(client):
    for side in ("left", "right"):
        name = f"/{side}/controller_manager/list_controllers"
        client.node.create_service(ListControllers, name, lambda _, answer: answer)
    code, lines = list_controllers()
    assert code == 1
    assert lines[-1] == (
        "arm control list_controllers: there is no /controller_manager, but there are "
        "/left/controller_manager, /right/controller_manager: choose one with -c"
    )
