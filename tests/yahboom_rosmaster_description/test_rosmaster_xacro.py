"""rosmaster_x3.urdf.xacro: its arguments, its frames and its masses."""

from functools import cache
from math import cos, sin

import numpy as np
import pytest
import yaml

from arm_control.hardware.info import parse_hardware_info
from arm_description import (
    Cylinder,
    Robot,
    XacroError,
    expand_xacro,
    forward_kinematics,
    parse_urdf,
    resolve_uri,
)

PACKAGE = "package://yahboom_rosmaster_description"
MODEL = f"{PACKAGE}/urdf/robots/rosmaster_x3.urdf.xacro"
WHEELS = ("front_left", "front_right", "back_left", "back_right")
FRAMES_AT = {
    "base_link": (0.0, 0.0, 0.0325),
    "front_left_wheel_link": (0.08, 0.0745, 0.0),
    "front_right_wheel_link": (0.08, -0.0745, 0.0),
    "back_left_wheel_link": (-0.08, 0.0745, 0.0),
    "back_right_wheel_link": (-0.08, -0.0745, 0.0),
    "cam_1_link": (0.105, 0.0, 0.0825),
    "cam_1_depth_frame": (0.105, 0.0, 0.0825),
    "cam_1_depth_optical_frame": (0.105, 0.0, 0.0825),
    "cam_1_infra1_frame": (0.105, 0.0, 0.0825),
    "cam_1_infra1_optical_frame": (0.105, 0.0, 0.0825),
    "cam_1_infra2_frame": (0.105, -0.05, 0.0825),
    "cam_1_infra2_optical_frame": (0.105, -0.05, 0.0825),
    "cam_1_color_frame": (0.105, 0.015, 0.0825),
    "cam_1_color_optical_frame": (0.105, 0.015, 0.0825),
    "laser_frame": (0.0, 0.0, 0.115),
    "imu_link": (0.0, 0.0, 0.0385),
}
"""Seen from base_footprint, as the original's."""
MASSES = {
    "base_link": 4.6,
    **{f"{wheel}_wheel_link": 9.1 for wheel in WHEELS},
    "cam_1_link": 0.072,
    "laser_frame": 0.185,
    "imu_link": 0.031,
}


@cache
def expand(**arguments: str) -> str:
    return expand_xacro(resolve_uri(MODEL), arguments)


def rosmaster(**arguments: str) -> Robot:
    return parse_urdf(expand(**arguments))


@pytest.mark.parametrize("prefix", ["", "left_"])
def test_every_frame_is_where_the_original_has_it(prefix):
    robot = rosmaster(prefix=prefix)
    poses = forward_kinematics(robot, {})

    assert robot.root == f"{prefix}base_footprint"
    assert set(poses) == {prefix + name for name in (*FRAMES_AT, "base_footprint")}
    for name, place in FRAMES_AT.items():
        assert poses[prefix + name][:3, 3] == pytest.approx(place, abs=1e-6), name


def test_the_camera_looks_up_and_ahead():
    optical = forward_kinematics(rosmaster(), {})["cam_1_color_optical_frame"]

    assert optical[:3, 2] == pytest.approx([cos(0.5), 0.0, sin(0.5)], abs=1e-6)
    assert optical[:3, 0] == pytest.approx([0.0, -1.0, 0.0], abs=1e-6)


@pytest.mark.parametrize("prefix", ["", "left_"])
def test_four_wheels_turn_about_their_axles_without_end(prefix):
    robot = rosmaster(prefix=prefix)

    assert [joint.name for joint in robot.movable_joints] == [
        f"{prefix}{wheel}_wheel_joint" for wheel in WHEELS
    ]
    for joint in robot.movable_joints:
        assert joint.type == "continuous"
        assert tuple(joint.axis) == (0.0, 1.0, 0.0)
        assert joint.limit is not None
        assert joint.limit.velocity == 50.0
        (collision,) = robot.link(joint.child).collisions
        assert isinstance(collision.geometry, Cylinder)
        assert collision.geometry.radius == 0.0325
        # Its axis lies along the axle.
        assert collision.origin.matrix()[:3, 2] == pytest.approx([0, -1, 0], abs=1e-4)


def test_a_wheel_turns_forwards_with_its_joint():
    turned = forward_kinematics(rosmaster(), {"back_left_wheel_joint": 0.5})

    assert turned["back_left_wheel_link"][:3, 0] == pytest.approx([cos(0.5), 0.0, -sin(0.5)])
    assert turned["back_right_wheel_link"][:3, :3] == pytest.approx(np.eye(3))


def test_the_masses_are_the_originals_and_lie_in_the_links():
    robot = rosmaster()

    masses = {link.name: link.inertial.mass for link in robot.links if link.inertial is not None}
    assert masses == MASSES
    for link in robot.links:
        if link.inertial is None:
            continue
        ixx, ixy, ixz, iyy, iyz, izz = link.inertial.inertia
        tensor = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
        low, middle, high = np.linalg.eigvalsh(tensor)
        assert low > 0
        assert high < low + middle + 1e-9
        assert high < link.inertial.mass * 0.15**2


@pytest.mark.parametrize(
    ("use_gazebo", "plugin"),
    [("true", "gz_ros2_control/GazeboSimSystem"), ("false", "mock_components/GenericSystem")],
)
def test_ros2_control_commands_the_speed_of_each_wheel(use_gazebo, plugin):
    (component,) = parse_hardware_info(expand(prefix="left_", use_gazebo=use_gazebo))

    assert component.plugin == plugin
    assert component.command_interface_names == tuple(
        f"left_{wheel}_wheel_joint/velocity" for wheel in WHEELS
    )


def test_a_value_that_is_no_choice_is_refused_with_the_choices():
    with pytest.raises(XacroError, match="use_gazebo can be true, false"):
        expand(use_gazebo="perhaps")


def test_rviz_has_the_fixed_frame_of_the_robot():
    path = resolve_uri(f"{PACKAGE}/config/rviz/yahboom_rosmaster_description.rviz")
    manager = yaml.safe_load(path.read_text(encoding="utf-8"))["Visualization Manager"]

    fixed = manager["Global Options"]["Fixed Frame"]
    assert fixed in {link.name for link in rosmaster().links}
    assert {display["Name"] for display in manager["Displays"]} == {"Grid", "RobotModel", "TF"}
