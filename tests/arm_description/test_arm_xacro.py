"""arm.urdf.xacro and arm.rviz: arguments, names, kinematics, interfaces, and what RViz shows."""

import itertools
from functools import cache

import numpy as np
import pytest
import yaml

from arm_description import (
    Robot,
    XacroError,
    expand_xacro,
    forward_kinematics,
    parse_urdf,
    parse_xml,
    resolve_uri,
)
from arm_gazebo.errors import SensorError
from arm_gazebo.sensors.camera_reader import parse_cameras

ARM = "package://arm_description/urdf/arm.urdf.xacro"
JOINTS = ("j0", "j1", "j2", "j3")

ARM_LINKS_AT_ZERO = {
    "base_link": (0.0, 0.0, 0.0),
    "base_turn": (-0.0011, -0.011, 0.05),
    "base_turn_rot": (-0.0011, 0.0045, 0.063),
    "dyn2": (-0.0011, 0.0045, 0.1015),
    "dyn2_r": (-0.0011, 0.0045, 0.1015),
    "f4": (-0.00414, 0.0045, 0.1485),
    "dyn3": (-0.00019, 0.00455, 0.213),
    "dyn3_r": (-0.00019, 0.00455, 0.213),
    "f5": (-0.00226, 0.00466, 0.259),
    "dyn4": (0.00169, 0.00476, 0.324),
    "dyn4_r": (0.00169, 0.00476, 0.324),
    "wrist": (0.00463, -0.00821, 0.34103),
    "dyn5": (0.0008, 0.0048, 0.36852),
    "dyn5_r": (0.0008, 0.0048, 0.36852),
    "crawer_base": (0.00074, -0.0102, 0.38752),
    "crawer_left": (-0.02923, 0.0049, 0.39747),
    "crawer_right": (0.03077, 0.00471, 0.39757),
}
"""Positions in base_link's frame, in m, read from the original robot."""

GRIPPER_AT = {
    (0.0, 0.5, 0.5, 1.0): (0.00074, -0.19373, 0.21949),
    (1.0, 0.5, 0.1, 0.5): (0.15077, -0.09084, 0.30659),
    (1.0, 2.0, -1.0, -2.0): (0.12586, -0.07413, 0.16221),
    (1.0, 0.5, 0.0, 0.0): (0.12615, -0.07498, 0.34546),
    (0.4, -0.1, 0.5, 0.4): (0.0347, -0.07573, 0.34828),
    (-2.57, 0.5, -1.2, -1.0): (0.0419, -0.06674, 0.29078),
}
"""Position of crawer_base in base_link's frame by joint positions, from the original robot."""


@cache
def expand(**arguments: str) -> str:
    return expand_xacro(resolve_uri(ARM), arguments)


def arm(**arguments: str) -> Robot:
    return parse_urdf(expand(**arguments))


def names(elements) -> set[str]:
    return {element.name for element in elements}


@pytest.mark.parametrize(
    ("base", "camera", "profile", "prefix"),
    list(
        itertools.product(
            ("fixed", "free"), ("front", "side", "none"), ("standard", "ros1"), ("", "left_")
        )
    ),
)
def test_every_combination_of_choices_is_one_tree(base, camera, profile, prefix):
    robot = arm(base=base, camera=camera, camera_profile=profile, prefix=prefix)

    expected = {prefix + link for link in ARM_LINKS_AT_ZERO}
    if base == "fixed":
        expected.add("world")
    if camera != "none":
        expected |= {f"{prefix}camera_link", f"{prefix}camera_optical_frame"}
    assert names(robot.links) == expected
    assert robot.root == ("world" if base == "fixed" else f"{prefix}base_link")


def test_the_joints_are_the_originals():
    robot = arm(base="free", camera="none")

    fixed = {
        "base_1_2",
        "base_turn_rot_dyn2",
        "dyn2_f4",
        "d4_dyn3",
        "dyn3_f5",
        "f5_dyn4",
        "f5_wrist",
        "wrist_dyn5",
        "dyn5_dyn5_r",
        "wrist_rotate_dyn5",
        "crawer_base_crawer_left",
        "crawer_base_crawer_right",
    }
    assert tuple(joint.name for joint in robot.movable_joints) == JOINTS
    assert names(robot.joints) - names(robot.movable_joints) == fixed


def test_the_links_stand_where_the_originals_stand():
    poses = forward_kinematics(arm(base="free", camera="none"), {})

    for link, position in ARM_LINKS_AT_ZERO.items():
        assert poses[link][:3, 3] == pytest.approx(position, abs=1e-4), link


@pytest.mark.parametrize(("positions", "gripper"), GRIPPER_AT.items())
def test_a_pose_means_the_same_as_in_the_original(positions, gripper):
    poses = forward_kinematics(
        arm(base="free", camera="none"), dict(zip(JOINTS, positions, strict=True))
    )

    assert poses["crawer_base"][:3, 3] == pytest.approx(gripper, abs=1e-4)


def test_the_axes_are_those_of_the_original():
    robot = arm(base="free", camera="none")
    poses = forward_kinematics(robot, {})

    axes = [poses[robot.joint(name).child][:3, :3] @ robot.joint(name).axis for name in JOINTS]

    expected = [(0, 0, 1), (1, 0, 0.0008), (1, -0.0016, 0.0016), (1, -0.0024, 0.0016)]
    assert np.array(axes) == pytest.approx(np.array(expected, dtype=float), abs=1e-4)


def test_a_fixed_base_is_31_mm_above_the_world():
    poses = forward_kinematics(arm(base="fixed"), {})

    assert poses["base_link"] == pytest.approx(
        np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.0313], [0, 0, 0, 1]], dtype=float)
    )


def test_the_front_camera_looks_along_minus_y_and_up():
    pose = forward_kinematics(arm(base="free", camera="front"), {})["camera_link"]

    assert pose[:3, 3] == pytest.approx((0.0, -0.05, 0.0))
    assert pose[:3, 0] == pytest.approx((0.0, -np.cos(0.2), np.sin(0.2)), abs=1e-3)


def test_the_side_camera_looks_back_at_the_arm():
    pose = forward_kinematics(arm(base="free", camera="side"), {})["camera_link"]

    assert pose[:3, 3] == pytest.approx((0.75, 0.0, 0.5))
    assert pose[:3, 0] == pytest.approx((-np.cos(0.3), 0.0, -np.sin(0.3)), abs=2e-3)


def test_the_optical_frame_looks_along_z_with_y_down():
    poses = forward_kinematics(arm(), {})
    camera, optical = poses["camera_link"], poses["camera_optical_frame"]

    assert optical[:3, 2] == pytest.approx(camera[:3, 0])
    assert optical[:3, 1] == pytest.approx(-camera[:3, 2])
    assert optical[:3, 3] == pytest.approx(camera[:3, 3])


def test_default_limits():
    robot = arm()

    limits = {joint.name: joint.limit for joint in robot.movable_joints}
    assert {name: (limit.lower, limit.upper) for name, limit in limits.items()} == {
        "j0": (-2.57, 2.57),
        "j1": (-3.14, 3.14),
        "j2": (-3.14, 3.14),
        "j3": (-3.14, 3.14),
    }
    assert {(limit.velocity, limit.effort) for limit in limits.values()} == {(2.0, 5.0)}


def test_limits_of_the_originals_can_be_chosen():
    robot = arm(velocity_limit="0.1", effort_limit="300", j1_limit="2.0")

    assert robot.joint("j1").limit is not None
    assert (robot.joint("j1").limit.lower, robot.joint("j1").limit.upper) == (-2.0, 2.0)
    assert {joint.limit.velocity for joint in robot.movable_joints} == {0.1}
    assert {joint.limit.effort for joint in robot.movable_joints} == {300.0}


def test_a_prefix_reaches_every_name_except_world():
    urdf = expand(prefix="left_")

    robot = parse_urdf(urdf)
    root = parse_xml(urdf)
    camera = parse_cameras(urdf)[0]
    assert {name for name in names(robot.links) if not name.startswith("left_")} == {"world"}
    assert all(name.startswith("left_") for name in names(robot.joints))
    assert [joint.get("name") for joint in root.findall("ros2_control/joint")] == [
        f"left_{name}" for name in JOINTS
    ]
    assert (camera.link, camera.optical_frame) == ("left_camera_link", "left_camera_optical_frame")


def test_the_hardware_can_be_chosen():
    control = parse_xml(expand(hardware="mock_components/GenericSystem")).find("ros2_control")

    assert control.findtext("hardware/plugin") == "mock_components/GenericSystem"


def test_every_joint_takes_position_velocity_and_effort():
    control = parse_xml(expand()).find("ros2_control")

    assert control.get("type") == "system"
    assert control.findtext("hardware/plugin") == "arm_gazebo/SimulatedHardware"
    for joint, name in zip(control.findall("joint"), JOINTS, strict=True):
        assert joint.get("name") == name
        for kind in ("command_interface", "state_interface"):
            interfaces = [element.get("name") for element in joint.findall(kind)]
            assert interfaces == ["position", "velocity", "effort"]


def test_every_joint_takes_position_only_as_in_the_original():
    system = parse_xml(expand(command_interfaces="position")).find("ros2_control")
    every = {
        kind: [f"{joint.get('name')}/{part.get('name')}"
               for joint in system.findall("joint") for part in joint.findall(kind)]
        for kind in ("command_interface", "state_interface")
    }  # fmt: skip
    assert every["command_interface"] == [f"{name}/position" for name in JOINTS]
    kinds = ("effort", "position", "velocity")
    assert sorted(every["state_interface"]) == [f"{n}/{kind}" for n in JOINTS for kind in kinds]


def test_initial_positions_are_those_of_the_arguments():
    urdf = expand(j0_pos="0.4", j1_pos="-0.1", j2_pos="0.5", j3_pos="1")

    path = "ros2_control/joint/state_interface[@name='position']/param[@name='initial_value']"
    values = [float(element.text) for element in parse_xml(urdf).findall(path)]
    assert values == [0.4, -0.1, 0.5, 1.0]


def test_the_standard_camera():
    (camera,) = parse_cameras(expand())

    assert (camera.width, camera.height, camera.hfov, camera.rate_hz) == (320, 240, 1.047, 30.0)
    assert (camera.near, camera.far, camera.noise_stddev) == (0.1, 100.0, 0.0)
    assert camera.image_topics == ("videocamera",)
    assert camera.info_topics == ("camera_info", "videocamera/camera_info")
    assert (camera.link, camera.optical_frame) == ("camera_link", "camera_optical_frame")


def test_the_large_camera():
    (camera,) = parse_cameras(expand(camera="side", camera_profile="large"))

    assert (camera.width, camera.height, camera.hfov) == (800, 800, 1.3962634)
    assert (camera.near, camera.far, camera.noise_stddev) == (0.02, 300.0, 0.007)
    assert camera.image_topics == ("videocamera", "camera/image_raw")
    assert camera.info_topics == ("camera_info", "videocamera/camera_info", "camera/camera_info")


def test_the_camera_of_ros_1_is_the_large_one_on_absolute_topics():
    (camera,) = parse_cameras(expand(camera="side", camera_profile="ros1"))

    assert (camera.width, camera.height, camera.hfov) == (800, 800, 1.3962634)
    assert (camera.near, camera.far, camera.noise_stddev) == (0.02, 300.0, 0.007)
    assert camera.image_topics == ("videocamera", "/camera/image_raw")
    assert camera.info_topics[-1] == "/camera/camera_info"


@pytest.mark.parametrize("profile", ["standard", "large", "ros1"])
def test_the_camera_has_the_size_and_the_field_of_view_that_are_given(profile):
    given = {"camera_width": "1280", "camera_height": "720", "camera_hfov": "1.2"}
    (camera,) = parse_cameras(expand(camera_profile=profile, **given))
    assert (camera.width, camera.height, camera.hfov) == (1280, 720, 1.2)
    (plain,) = parse_cameras(expand(camera_profile=profile))
    assert (camera.image_topics, camera.near) == (plain.image_topics, plain.near)
    (wider,) = parse_cameras(expand(camera_profile=profile, camera_width="1000"))
    assert (wider.width, wider.height, wider.hfov) == (1000, plain.height, plain.hfov)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"camera_width": "0"}, "<image/width> .* a whole number from 1 to 8192, not '0'"),
        ({"camera_height": "2.5"}, "<image/height> .* a whole number from 1 to 8192, not '2.5'"),
        ({"camera_hfov": "0"}, "<horizontal_fov> .* in \\(0, pi\\), not '0'"),
    ],
)
def test_a_camera_of_no_size_is_refused(arguments, said):
    with pytest.raises(SensorError, match=said):
        parse_cameras(expand(**arguments))


def test_the_camera_has_the_pose_and_the_box_that_are_given():
    robot = arm(
        base="free", camera_xyz="0 0 0", camera_rpy="0 0 -1.57", camera_box="0.03 0.03 0.03",
        camera_box_xyz="-0.001 0 0", camera_box_rgba="0.5 0 0.5 1",
    )  # fmt: skip
    pose = forward_kinematics(robot, {})["camera_link"]
    assert pose[:3, 3] == pytest.approx([0.0, 0.0, 0.0])
    assert pose[:3, 0] == pytest.approx([np.cos(1.57), -np.sin(1.57), 0.0])
    (camera,) = (link for link in robot.links if link.name == "camera_link")
    (box,) = camera.visuals
    assert box.geometry.size == (0.03, 0.03, 0.03)
    assert box.origin.xyz == (-0.001, 0.0, 0.0)
    assert box.material.rgba == (0.5, 0.0, 0.5, 1.0)


def test_the_camera_keeps_what_is_not_given():
    robot = arm(base="free", camera_xyz="0 0 0.1")
    pose = forward_kinematics(robot, {})["camera_link"]
    front = forward_kinematics(arm(base="free"), {})["camera_link"]
    assert pose[:3, 3] == pytest.approx([0.0, 0.0, 0.1])
    assert pose[:3, :3] == pytest.approx(front[:3, :3])
    posts = [len(next(li for li in r.links if li.name == "camera_link").visuals)
             for r in (arm(), robot)]  # fmt: skip
    assert posts == [3, 2]


def test_the_servos_have_the_given_colour():
    def colours(robot):
        (case, *_) = next(link for link in robot.links if link.name == "dyn2").visuals
        return case.material.rgba

    assert colours(arm()) == (0.15, 0.16, 0.18, 1.0)
    assert colours(arm(servo_rgba="0.5 0.5 0.5 1")) == (0.5, 0.5, 0.5, 1.0)


def test_without_a_camera_there_is_no_sensor():
    assert parse_cameras(expand(camera="none")) == ()


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"base": "loose"}, "base:=loose is not a choice; base can be fixed, free"),
        ({"camera": "top"}, "camera:=top is not a choice; camera can be front, side, none"),
        (
            {"camera_profile": "huge"},
            "camera_profile:=huge is not a choice; camera_profile can be standard, large, ros1",
        ),
        ({"camera_xyz": "1 2"}, "camera_xyz:=1 2 has 2 numbers; it takes 3"),
        ({"camera_width": "wide"}, "camera_width has 'wide', which is not a number"),
        ({"camera_hfov": "1 2"}, "camera_hfov:=1 2 has 2 numbers; it takes 1"),
        ({"servo_rgba": "1 grey 0 1"}, "servo_rgba has 'grey', which is not a number"),
        (
            {"camera": "none", "camera_profile": "huge"},
            "camera_profile:=huge is not a choice; camera_profile can be standard, large, ros1",
        ),
        ({"j2_pos": "up"}, "j2_pos:=up is not a number"),
        ({"j2_pos": "nan"}, "j2_pos:=nan is not a number"),
        ({"velocity_limit": "0"}, "velocity_limit:=0 must be above 0"),
        ({"effort_limit": "-5.0"}, "effort_limit:=-5.0 must be above 0"),
        ({"j1_limit": ""}, "j1_limit:= is not a number"),
    ],
)
def test_nonsense_is_refused_with_a_sentence(arguments, sentence):
    with pytest.raises(XacroError, match=sentence):
        expand(**arguments)


def test_every_visual_has_a_colour():
    robot = arm()

    visuals = [visual for link in robot.links for visual in link.visuals]
    assert visuals
    assert all(visual.material and visual.material.rgba for visual in visuals)


def visualization() -> dict:
    path = resolve_uri("package://arm_description/config/rviz/arm.rviz")
    return yaml.safe_load(path.read_text(encoding="utf-8"))["Visualization Manager"]


def test_the_fixed_frame_is_the_root_of_the_robot():
    robot = parse_urdf(expand_xacro(resolve_uri("package://arm_description/urdf/arm.urdf.xacro")))

    assert visualization()["Global Options"]["Fixed Frame"] == robot.root


def test_it_shows_the_robot_its_frames_and_the_camera():
    displays = {display["Name"]: display for display in visualization()["Displays"]}

    assert set(displays) == {"Grid", "RobotModel", "TF", "Image"}
    assert displays["RobotModel"]["Description Topic"]["Value"] == "/robot_description"
    assert displays["RobotModel"]["Description Topic"]["Durability Policy"] == "Transient Local"
    assert displays["Image"]["Topic"]["Value"] == "/videocamera"
