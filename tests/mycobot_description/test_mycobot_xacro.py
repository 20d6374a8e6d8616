"""mycobot_280.urdf.xacro: its arguments, its kinematics, its gripper and its masses."""

from functools import cache

import numpy as np
import pytest
from robots import MYCOBOT_ARM

from arm_control.hardware.info import parse_hardware_info
from arm_description import (
    Box,
    Robot,
    XacroError,
    expand_xacro,
    forward_kinematics,
    parse_urdf,
    resolve_uri,
)
from arm_gazebo.sensors.camera_reader import parse_cameras

MODEL = "package://mycobot_description/urdf/robots/mycobot_280.urdf.xacro"
DRIVEN = "gripper_controller"
FOLLOWERS = {
    "gripper_base_to_gripper_left2": 1.0,
    "gripper_left3_to_gripper_left1": -1.0,
    "gripper_base_to_gripper_right3": -1.0,
    "gripper_base_to_gripper_right2": -1.0,
    "gripper_right3_to_gripper_right1": 1.0,
}
MASSES = {
    "base_link": 0.33,
    "link1": 0.12,
    "link2": 0.19,
    "link3": 0.16,
    "link4": 0.124,
    "link5": 0.11,
    "link6": 0.0739,
    "link6_flange": 0.035,
    "gripper_base": 0.07,
    **{f"gripper_{side}{n}": 0.007 for side in ("left", "right") for n in (1, 2, 3)},
}

FLANGE_AT = {
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0): ((0.06062, 0.0456, 0.41014), (0.0, 1.0, 0.0)),
    (1.345, -1.23, 0.264, -0.296, 0.389, -1.5): (
        (-0.24912, 0.10168, 0.20409),
        (-0.35898, -0.30668, -0.88152),
    ),
    (0.0, 0.0, 1.5708, 1.5708, 0.0, 0.0): ((0.06062, -0.1416, 0.16778), (0.0, -1.0, -1.0e-05)),
    (0.5, 0.2, 0.3, 0.1, 0.7, 0.0): ((0.06601, -0.05566, 0.4031), (-0.86799, 0.24512, 0.43186)),
}
"""Place and z axis of the flange in base_link's frame by joint positions, from the original."""

PAD_GAPS = {0.15: 0.0432, 0.0: 0.039, -0.24: 0.0298, -0.34: 0.0252, -0.5: 0.017, -0.7: 0.0057}
"""Between the pads, in m, by the position of gripper_controller, from the original."""


@cache
def expand(**arguments: str) -> str:
    return expand_xacro(resolve_uri(MODEL), arguments)


def mycobot(**arguments: str) -> Robot:
    return parse_urdf(expand(**arguments))


def names(elements) -> set[str]:
    return {element.name for element in elements}


@pytest.mark.parametrize("prefix", ["", "left_"])
@pytest.mark.parametrize("use_gripper", ["true", "false"])
@pytest.mark.parametrize("add_world", ["true", "false"])
def test_every_combination_of_choices_is_one_tree(prefix, use_gripper, add_world):
    robot = mycobot(prefix=prefix, use_gripper=use_gripper, add_world=add_world)

    with_gripper = use_gripper == "true"
    links = {prefix + link for link in MASSES if with_gripper or "gripper" not in link}
    if add_world == "true":
        links.add("world")
    assert names(robot.links) == links
    assert robot.root == ("world" if add_world == "true" else f"{prefix}base_link")
    joints = {*MYCOBOT_ARM, *((DRIVEN, *FOLLOWERS) if with_gripper else ())}
    assert names(robot.movable_joints) == {prefixed(joint, prefix) for joint in joints}


def prefixed(joint: str, prefix: str) -> str:
    """Return the name of a joint with the prefix before the names of both links."""
    return prefix + joint.replace("_to_", f"_to_{prefix}")


def test_a_prefix_is_before_the_names_of_both_links_of_a_joint():
    robot = mycobot(prefix="left_", use_gripper="true")
    assert {
        "left_base_link_to_left_link1",
        "left_link1_to_left_link2",
        "left_link6_to_left_link6_flange",
        "left_link6_flange_to_left_gripper_base",
        "left_gripper_base_to_left_gripper_right2",
    } <= names(robot.joints)


def test_the_base_and_the_flange_can_have_other_names():
    robot = mycobot(base_link="foot", flange_link="tool0", prefix="a_")

    assert {"a_foot", "a_tool0"} <= names(robot.links)
    assert {"a_foot_to_a_link1", "a_link6_to_a_tool0"} <= names(robot.joints)
    commanded = {joint.name for joint in parse_hardware_info(expand(flange_link="tool0"))[0].joints}
    assert "link6_to_tool0" in commanded


@pytest.mark.parametrize(
    ("argument", "value", "choices"),
    [
        ("base_type", "wheels", "g_shape"),
        ("gripper_type", "vacuum", "adaptive_gripper"),
        ("use_gripper", "maybe", "true, false"),
        ("add_world", "2", "true, false"),
        ("use_gazebo", "perhaps", "true, false"),
        ("use_camera", "soon", "true, false"),
    ],
)
def test_a_value_that_is_no_choice_is_refused_with_the_choices(argument, value, choices):
    with pytest.raises(XacroError, match=f"{argument} can be {choices}"):
        expand(**{argument: value})


@pytest.mark.parametrize(("positions", "flange"), FLANGE_AT.items())
@pytest.mark.parametrize("prefix", ["", "left_"])
def test_a_pose_means_the_same_as_in_the_original(positions, flange, prefix):
    joints = dict(zip([prefixed(joint, prefix) for joint in MYCOBOT_ARM], positions, strict=True))
    poses = forward_kinematics(mycobot(add_world="false", prefix=prefix), joints)

    place, axis = flange
    pose = poses[f"{prefix}link6_flange"]
    assert pose[:3, 3] == pytest.approx(place, abs=2e-5)
    assert pose[:3, 2] == pytest.approx(axis, abs=2e-5)


def pad_faces(robot: Robot, position: float) -> dict[str, float]:
    """Return where the inner faces of the pads are along x of the gripper, by link."""
    poses = forward_kinematics(robot, {DRIVEN: position})
    into_gripper = np.linalg.inv(poses["gripper_base"])
    faces = {}
    for link, inwards in (("gripper_left1", 1.0), ("gripper_right1", -1.0)):
        (collision,) = robot.link(link).collisions
        assert isinstance(collision.geometry, Box)
        half = np.array([inwards * collision.geometry.size[0] / 2, 0.0, 0.0, 1.0])
        faces[link] = (into_gripper @ poses[link] @ collision.origin.matrix() @ half)[0]
    return faces


@pytest.mark.parametrize(("position", "gap"), PAD_GAPS.items())
def test_the_pads_are_as_far_apart_as_the_originals(position, gap):
    faces = pad_faces(mycobot(), position)

    assert faces["gripper_right1"] - faces["gripper_left1"] == pytest.approx(gap, abs=1e-4)
    assert faces["gripper_right1"] == pytest.approx(-faces["gripper_left1"], abs=1e-6)


@pytest.mark.parametrize("prefix", ["", "left_"])
def test_five_joints_follow_the_driven_one_within_their_limits(prefix):
    robot = mycobot(prefix=prefix)
    driven = robot.joint(prefix + DRIVEN)

    followers = {joint.name: joint.mimic for joint in robot.joints if joint.mimic is not None}
    assert {name: mimic.multiplier for name, mimic in followers.items()} == {
        prefixed(name, prefix): multiplier for name, multiplier in FOLLOWERS.items()
    }
    assert driven.limit is not None
    assert (driven.limit.lower, driven.limit.upper) == (-0.7, 0.15)
    for name, mimic in followers.items():
        limit = robot.joint(name).limit
        assert limit is not None
        assert mimic.joint == driven.name
        for end in (driven.limit.lower, driven.limit.upper):
            assert limit.lower <= mimic.multiplier * end <= limit.upper, name


CAMERA_AT = {
    "torso_link": (0.22, -0.3, 0.0),
    "camera_head_link": (0.22, -0.29, 0.5),
    "camera_head_depth_optical_frame": (0.22, -0.29, 0.5),
    "camera_head_infra2_frame": (0.27, -0.29, 0.5),
    "camera_head_color_optical_frame": (0.205, -0.29, 0.5),
}
"""Where the camera's frames are in the world, from the original."""


@pytest.mark.parametrize("prefix", ["", "left_"])
def test_the_camera_stands_where_the_original_does_and_looks_at_the_table(prefix):
    text = expand(prefix=prefix, use_camera="true")
    poses = forward_kinematics(parse_urdf(text), {})
    for link, place in CAMERA_AT.items():
        assert poses[prefix + link][:3, 3] == pytest.approx(place, abs=1e-6), link
    (camera,) = parse_cameras(text)
    assert camera.optical_frame == f"{prefix}camera_head_depth_optical_frame"
    tilt = np.radians(25)
    forward = poses[camera.optical_frame][:3, 2]
    assert forward == pytest.approx([0, np.cos(tilt), -np.sin(tilt)], abs=1e-6)
    assert camera.points_topics == (f"{prefix}camera_head/depth/color/points",)


def test_there_is_no_camera_unless_it_is_wanted():
    assert parse_cameras(expand()) == ()


@pytest.mark.parametrize("use_gripper", ["true", "false"])
def test_ros2_control_commands_what_the_robot_has_and_only_that(use_gripper):
    text = expand(prefix="left_", use_gripper=use_gripper, use_gazebo="true")
    (component,) = parse_hardware_info(text)

    gripper = ["left_" + DRIVEN] if use_gripper == "true" else []
    commanded = [joint.name for joint in component.joints if joint.command_interfaces]
    assert commanded == [*(prefixed(joint, "left_") for joint in MYCOBOT_ARM), *gripper]
    assert {joint.name for joint in component.joints} == names(parse_urdf(text).movable_joints)
    assert component.plugin == "gz_ros2_control/GazeboSimSystem"
    (mock,) = parse_hardware_info(expand())
    assert mock.plugin == "mock_components/GenericSystem"


def test_the_masses_are_the_originals_and_lie_in_the_links():
    robot = mycobot()

    for link in robot.links:
        if link.name == "world":
            assert link.inertial is None
            continue
        assert link.inertial is not None
        assert link.inertial.mass == MASSES[link.name]
        ixx, ixy, ixz, iyy, iyz, izz = link.inertial.inertia
        tensor = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
        low, middle, high = np.linalg.eigvalsh(tensor)
        assert low > 0
        assert high < low + middle
        # As of a body within a decimetre: not a thousand times as sluggish.
        assert high < link.inertial.mass * 0.1**2


def test_the_base_stands_25_mm_below_its_frame():
    (collision,) = mycobot().link("base_link").collisions

    assert isinstance(collision.geometry, Box)
    assert collision.origin.xyz[2] - collision.geometry.size[2] / 2 == pytest.approx(-0.025)
