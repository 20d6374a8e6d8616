"""Forward kinematics: golden figures of the original arm, and yourdfpy as a second opinion."""

import math
from typing import Any

import numpy as np
import pytest
import yourdfpy
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree

from arm_description import KinematicsError, Robot, forward_kinematics, parse_urdf
from arm_description.kinematics import resolve_mimics

ORIGINAL_ARM = (
    # joint, type, parent, child, xyz, rpy; every axis is z
    ("base_1_2", "fixed", "base_link", "base_turn", "-0.0011 -0.011 0.05", "0 0 0"),
    ("j0", "continuous", "base_turn", "base_turn_rot", "0 0.0155 0.013", "0 0 -1.57"),
    ("base_turn_rot_dyn2", "fixed", "base_turn_rot", "dyn2", "0 0 0.0385", "0 1.57 1.57"),
    ("j1", "continuous", "dyn2", "dyn2_r", "0 0 0", "0 0 0"),
    ("dyn2_f4", "fixed", "dyn2_r", "f4", "-0.047 0 -0.003", "0 1.57 1.57"),
    ("d4_dyn3", "fixed", "f4", "dyn3", "-0.004 0.0645 0", "-1.57 3.14 1.57"),
    ("j2", "continuous", "dyn3", "dyn3_r", "0 0 0", "0 0 0"),
    ("dyn3_f5", "fixed", "dyn3_r", "f5", "-0.046 0 -0.002", "1.57 1.57 3.1415"),
    ("f5_dyn4", "fixed", "f5", "dyn4", "-0.004 0.065 0", "-1.57 3.1415 1.57"),
    ("j3", "continuous", "dyn4", "dyn4_r", "0 0 0", "0 0 0"),
    ("f5_wrist", "fixed", "dyn4_r", "wrist", "-0.017 -0.013 0.003", "1.57 1.57 -1.57"),
    ("wrist_dyn5", "fixed", "wrist", "dyn5", "0.0038 -0.013 0.0275", "0 0 1.57"),
    ("dyn5_dyn5_r", "fixed", "dyn5", "dyn5_r", "0 0 0", "0 0 0"),
    ("wrist_rotate_dyn5", "fixed", "dyn5_r", "crawer_base", "0.015 0 0.019", "0 0 1.57"),
    ("left", "fixed", "crawer_base", "crawer_left", "-0.03 0.015 0.01", "0 -1.57 0"),
    ("right", "fixed", "crawer_base", "crawer_right", "0.03 0.015 0.01", "3.1415 -1.57 0"),
)

LINKS_AT_ZERO = {
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

GRIPPER_AT = {
    (0.0, 0.0, 0.0, 0.0): (0.00074, -0.0102, 0.38752),
    (0.0, 0.5, 0.5, 1.0): (0.00074, -0.19373, 0.21949),
    (1.0, 0.5, 0.1, 0.5): (0.15077, -0.09084, 0.30659),
    (1.0, 2.0, -1.0, -2.0): (0.12586, -0.07413, 0.16221),
    (1.0, 0.5, 0.0, 0.0): (0.12615, -0.07498, 0.34546),
    (0.4, -0.1, 0.5, 0.4): (0.0347, -0.07573, 0.34828),
    (-2.57, 0.5, -1.2, -1.0): (0.0419, -0.06674, 0.29078),
}
"""Where crawer_base is, by j0..j3. Measured on the original robot, rounded to 0.01 mm."""

ROUNDING_M = 0.6e-5


def original_arm() -> Robot:
    links = "".join(f"<link name='{name}'/>" for name in LINKS_AT_ZERO)
    joints = "".join(
        f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>"
        f"<origin xyz='{xyz}' rpy='{rpy}'/><axis xyz='0 0 1'/></joint>"
        for name, kind, parent, child, xyz, rpy in ORIGINAL_ARM
    )
    return parse_urdf(f"<robot name='arm'>{links}{joints}</robot>")


def test_the_original_arms_links_at_zero():
    poses = forward_kinematics(original_arm(), {})
    assert poses.keys() == LINKS_AT_ZERO.keys()
    for link, xyz in LINKS_AT_ZERO.items():
        assert poses[link][:3, 3] == pytest.approx(xyz, abs=ROUNDING_M)


@pytest.mark.parametrize("q", GRIPPER_AT)
def test_the_original_arms_gripper(q):
    poses = forward_kinematics(original_arm(), dict(zip(("j0", "j1", "j2", "j3"), q, strict=True)))
    assert poses["crawer_base"][:3, 3] == pytest.approx(GRIPPER_AT[q], abs=ROUNDING_M)


LIMIT = "<limit lower='-9' upper='9' effort='1' velocity='1'/>"


def slides(*mimics: str) -> Robot:
    """Return prismatic joints a, b, c ... along x, each with this inside."""
    links = "".join(f"<link name='l{n}'/>" for n in range(len(mimics) + 1))
    joints = "".join(
        f"<joint name='{name}' type='prismatic'><parent link='l{n}'/><child link='l{n + 1}'/>"
        f"{LIMIT}{mimic}</joint>"
        for n, (name, mimic) in enumerate(zip("abcdefgh", mimics, strict=False))
    )
    return parse_urdf(f"<robot name='r'>{links}{joints}</robot>")


def test_a_prismatic_joint_slides_along_its_axis():
    poses = forward_kinematics(slides(""), {"a": 0.25})
    assert poses["l1"][:3, 3] == pytest.approx((0.25, 0.0, 0.0))


def test_a_mimic_is_resolved_with_multiplier_and_offset():
    robot = slides("", "<mimic joint='a' multiplier='-2' offset='0.5'/>")
    assert resolve_mimics(robot, {"a": 1.0}) == {"a": 1.0, "b": -1.5}


def test_a_chain_of_mimics_is_resolved_in_any_order():
    robot = slides(
        "<mimic joint='b' multiplier='2' offset='1'/>", "<mimic joint='c' multiplier='3'/>", ""
    )
    assert resolve_mimics(robot, {"c": 1.0}) == {"c": 1.0, "b": 3.0, "a": 7.0}


def test_a_leader_without_a_position_is_at_zero():
    robot = slides("", "<mimic joint='a' offset='0.5'/>")
    assert forward_kinematics(robot, {})["l2"][0, 3] == pytest.approx(0.5)


def test_a_position_that_is_given_stands_also_for_a_follower():
    robot = slides("", "<mimic joint='a'/>")
    assert resolve_mimics(robot, {"a": 1.0, "b": 5.0}) == {"a": 1.0, "b": 5.0}


def test_floating_and_planar_joints_stay_at_their_origins():
    text = "".join(
        f"<link name='l{n}'/><joint name='j{n}' type='{kind}'><parent link='l{n - 1}'/>"
        f"<child link='l{n}'/><origin xyz='0 0 1'/></joint>"
        for n, kind in ((1, "floating"), (2, "planar"))
    )
    robot = parse_urdf(f"<robot name='r'><link name='l0'/>{text}</robot>")
    poses = forward_kinematics(robot, {"j1": 3.0, "j2": 3.0})
    assert poses["l2"][:3, 3] == pytest.approx((0, 0, 2))
    assert np.array_equal(poses["l2"][:3, :3], np.eye(3))


def test_an_unknown_joint_is_refused_with_those_that_exist():
    with pytest.raises(KinematicsError, match=r"^no joint 'j9'; the robot has a, b$"):
        forward_kinematics(slides("", ""), {"j9": 0.0})


@pytest.mark.parametrize("position", [math.nan, math.inf])
def test_a_position_that_is_no_number_is_refused(position):
    with pytest.raises(KinematicsError, match="joint 'a' has the position"):
        forward_kinematics(slides(""), {"a": position})


NUMBERS = st.floats(-3.0, 3.0).map(lambda value: round(value, 3))
VECTORS = st.tuples(NUMBERS, NUMBERS, NUMBERS)


@st.composite
def trees(draw: st.DrawFn) -> tuple[str, dict[str, float]]:
    """Return a URDF with a random tree of joints, and positions of those that move."""
    count = draw(st.integers(1, 7))
    positions: dict[str, float] = {}
    parts = ["<robot name='r'><link name='l0'/>"]
    for n in range(1, count + 1):
        kind = draw(st.sampled_from(["fixed", "revolute", "continuous", "prismatic"]))
        axis = draw(VECTORS.filter(lambda xyz: np.linalg.norm(xyz) > 0.1))
        unit = np.asarray(axis) / np.linalg.norm(axis)
        leaders = [name for name in positions if draw(st.booleans())]
        mimic = ""
        if leaders and kind != "fixed" and draw(st.booleans()):
            mimic = f"<mimic joint='{leaders[0]}' multiplier='{draw(NUMBERS)}' offset='0.25'/>"
        elif kind != "fixed":
            positions[f"j{n}"] = draw(NUMBERS)
        numbers = [" ".join(map(repr, map(float, x))) for x in (draw(VECTORS), draw(VECTORS), unit)]
        parts.append(
            f"<link name='l{n}'/><joint name='j{n}' type='{kind}'>"
            f"<parent link='l{draw(st.integers(0, n - 1))}'/><child link='l{n}'/>"
            f"<origin xyz='{numbers[0]}' rpy='{numbers[1]}'/><axis xyz='{numbers[2]}'/>"
            f"{LIMIT}{mimic}</joint>"
        )
    return "".join([*parts, "</robot>"]), positions


def second_opinion(text: str, positions: dict[str, float]) -> Any:
    loader = yourdfpy.URDF(
        yourdfpy.URDF._parse_robot(xml_element=etree.fromstring(text)),
        load_meshes=False,
        load_collision_meshes=False,
    )
    loader.update_cfg(positions)
    return loader


@settings(deadline=None)
@given(trees())
def test_yourdfpy_puts_every_link_at_the_same_place(tree):
    text, positions = tree
    robot = parse_urdf(text)
    oracle = second_opinion(text, positions)
    for link, pose in forward_kinematics(robot, positions).items():
        assert np.allclose(pose, oracle.get_transform(link, robot.root), atol=1e-9)
