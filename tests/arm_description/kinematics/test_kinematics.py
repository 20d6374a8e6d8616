"""Forward kinematics, with yourdfpy as a second opinion.

The golden figures of the original arm are in test_arm_xacro.py, where the shipped file meets them.
"""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree

from arm_description import KinematicsError, Robot, forward_kinematics, parse_urdf
from arm_description.kinematics.forward import resolve_mimics

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


def test_a_given_position_of_a_mimic_joint_is_kept():
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
def test_a_position_that_is_not_finite_is_refused(position):
    with pytest.raises(KinematicsError, match="joint 'a' has a position that is not finite"):
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
    import yourdfpy  # two seconds of every worker that collects this file, if above

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
