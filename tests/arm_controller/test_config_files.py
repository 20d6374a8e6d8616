"""The shipped parameter and pose files are what the nodes read."""

from pathlib import Path

import pytest
import yaml
from ament_index_python.packages import get_package_share_directory

from arm_controller.parameter_values import read_pose, read_zero_or_more
from arm_controller.pose_file import read_pose_file

CONFIG = Path(get_package_share_directory("arm_controller")) / "config"
JOINTS = ("j0", "j1", "j2", "j3")

POSES = {
    "params.yaml": (0.4, -0.1, 0.5, 0.4),
    "params_left_bent.yaml": (1.0, 0.5, 0.1, 0.5),
    "params_left_straight.yaml": (1.0, 0.5, 0.0, 0.0),
    "params_right_folded.yaml": (-2.57, 0.5, -1.2, -1.0),
}


def test_every_parameter_file_is_known_here():
    assert {path.name for path in CONFIG.glob("params*.yaml")} == {*POSES, "params_ros1.yaml"}


@pytest.mark.parametrize("name", POSES)
def test_a_parameter_file_holds_the_pose_of_the_original(name):
    node, settings = yaml.safe_load((CONFIG / name).read_text()).popitem()
    parameters = settings["ros__parameters"]
    pose = read_pose(parameters.pop("desired_param"), JOINTS)
    assert node == "arm_controller_node"
    assert pose is not None
    assert pose.positions == POSES[name]
    read_zero_or_more(parameters.pop("print_period", 1.0))
    assert parameters == {}


def test_the_ros1_file_sends_the_originals_pose_to_each_joint_ten_times_a_second():
    node, settings = yaml.safe_load((CONFIG / "params_ros1.yaml").read_text()).popitem()
    assert node == "/arm/arm_controller_node"
    assert settings["ros__parameters"] == {
        "command_topic": "{joint}p_controller/command",
        "desired_param": [-5.0, 0.5, -1.2, -1.0],
        "check_limits": False,
        "publish_rate": 10.0,
        "print_period": 1.0,
    }


def test_the_defined_poses_are_the_five_of_the_original():
    poses = read_pose_file(CONFIG / "poses.yaml", JOINTS)
    assert [pose.positions for pose in poses] == [
        (0.5, 0.5, 0.5, 0.5),
        (0.7, 1.4, 0.5, 0.5),
        (0.5, 1.0, 0.6, 0.6),
        (0.3, 0.6, 0.3, 0.3),
        (0.0, 0.0, 0.0, 0.0),
    ]
