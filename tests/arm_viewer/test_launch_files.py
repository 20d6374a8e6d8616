"""The launch files that open the page."""

import os

import pytest

from launch_py.errors import NodeParameterError
from launch_py.launch_description import expand_description, survey_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.system.packages import Packages


@pytest.mark.parametrize(
    ("package", "file"),
    [
        ("arm_viewer", "viewer.launch.py"),
        ("arm_description", "display.launch.py"),
        ("arm_gazebo", "sim.launch.py"),
        ("arm_gazebo", "arm_gazebo.launch.py"),
        ("mycobot_description", "robot_state_publisher.launch.py"),
        ("mycobot_gazebo", "mycobot.gazebo.launch.py"),
        ("mycobot_gazebo", "pick_and_place.launch.py"),
        ("gz_ros2_control_demos", "diff_drive_example.launch.py"),
        ("ros_gz_sim", "gz_sim.launch.py"),
        ("yahboom_rosmaster_description", "robot_state_publisher.launch.py"),
    ],
)
def test_whatever_opens_the_page_takes_its_port(package, file):
    path = Packages(os.environ).launch_file(package, file)
    arguments = survey_description(read_launch_file(path), dict(os.environ), path).arguments
    assert arguments["viewer_port"].default == "8080"


def test_an_invalid_port_is_refused_before_anything_starts():
    path = Packages(os.environ).launch_file("arm_viewer", "viewer.launch.py")
    arguments = {"viewer_port": "abc"}
    with pytest.raises(NodeParameterError, match="parameter 'port': 'abc' is not an integer"):
        expand_description(read_launch_file(path), arguments, dict(os.environ), path)
