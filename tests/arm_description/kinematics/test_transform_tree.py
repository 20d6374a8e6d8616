"""The transforms that robot_state_publisher sends, against forward kinematics."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from arm_description import Robot, forward_kinematics, parse_urdf
from arm_description.kinematics.forward import Frame, TransformTree, resolve_mimics
from arm_node.rigid_transform import RigidTransform

LIMIT = "<limit lower='-9' upper='9' effort='1' velocity='1'/>"


def robot(*joints: tuple[str, str, str]) -> Robot:
    """Return a chain of joints: (name, type, inside)."""
    text = "".join(
        f"<link name='l{n}'/><joint name='{name}' type='{kind}'><parent link='l{n - 1}'/>"
        f"<child link='l{n}'/><origin xyz='0.1 0.2 0.{n}' rpy='{n} -0.5 0.7'/>"
        f"<axis xyz='1 {n} -2'/>{LIMIT}{inside}</joint>"
        for n, (name, kind, inside) in enumerate(joints, start=1)
    )
    return parse_urdf(f"<robot name='r'><link name='l0'/>{text}</robot>")


MIXED = robot(
    ("a", "revolute", ""),
    ("f", "fixed", ""),
    ("b", "prismatic", ""),
    ("c", "continuous", "<mimic joint='a' multiplier='-2' offset='0.3'/>"),
    ("d", "prismatic", "<mimic joint='c' multiplier='0.5' offset='0.1'/>"),
    ("p", "planar", ""),
    ("g", "floating", ""),
)


def matrix(row: np.ndarray) -> np.ndarray:
    """Return the (4, 4) transform of x, y, z and a quaternion."""
    return np.array(RigidTransform(tuple(row[:3]), tuple(row[3:])).matrix())


def expected(frame: Frame, positions: dict[str, float]) -> np.ndarray:
    poses = forward_kinematics(MIXED, positions)
    return np.linalg.inv(poses[frame.parent]) @ poses[frame.child]


def moved(names: list[str]) -> list[str]:
    """Return the child links that a message about these joints moves."""
    return [frame.child for frame in TransformTree(MIXED).motion(names).frames]


def test_fixed_and_planar_joints_stand_still_and_floating_ones_are_left_out():
    tree = TransformTree(MIXED)
    assert tree.static_frames == (Frame("l1", "l2"), Frame("l5", "l6"))
    for frame, row in zip(tree.static_frames, tree.static_transforms, strict=True):
        assert np.allclose(matrix(row), expected(frame, {}))


def test_a_robot_without_fixed_joints_has_no_static_transforms():
    assert TransformTree(robot(("a", "continuous", ""))).static_transforms.shape == (0, 7)


POSITIONS = st.floats(-4.0, 4.0)


@settings(deadline=None)
@given(POSITIONS, POSITIONS)
def test_all_moving_transforms_are_those_of_forward_kinematics(a, b):
    motion = TransformTree(MIXED).motion(["b", "a"])
    positions = {"a": a, "b": b}
    rows = motion.transforms(np.array([b, a]))
    assert [frame.child for frame in motion.frames] == ["l1", "l3", "l4", "l5"]
    assert np.allclose(np.linalg.norm(rows[:, 3:], axis=1), 1.0)
    for frame, row in zip(motion.frames, rows, strict=True):
        assert np.allclose(matrix(row), expected(frame, positions), atol=1e-12)


def test_only_what_a_message_names_moves_and_what_mimics_it():
    assert moved(["b"]) == ["l3"]
    assert moved(["a"]) == ["l1", "l4", "l5"]
    assert moved(["c"]) == ["l4", "l5"]
    assert moved(["d"]) == ["l5"]


def test_unknown_fixed_planar_and_floating_names_move_nothing():
    assert moved(["x", "f", "p", "g", ""]) == []


def test_a_follower_that_the_message_names_has_its_own_position():
    motion = TransformTree(MIXED).motion(["a", "c"])
    moved_to = motion.transforms(np.array([1.0, 0.25]))
    rows = {frame.child: row for frame, row in zip(motion.frames, moved_to, strict=True)}
    positions = {"a": 1.0, "c": 0.25}
    assert np.allclose(matrix(rows["l4"]), expected(Frame("l3", "l4"), positions))
    assert np.allclose(matrix(rows["l5"]), expected(Frame("l4", "l5"), positions))
    assert resolve_mimics(MIXED, positions)["d"] == pytest.approx(0.225)


@pytest.mark.parametrize("position", [1e308, -1e308, math.nan, math.inf])
def test_a_follower_whose_position_overflows_has_a_row_that_is_not_finite(position):
    leader = ("a", "prismatic", "")
    follower = ("b", "prismatic", "<mimic joint='a' multiplier='10' offset='1'/>")
    motion = TransformTree(robot(leader, follower)).motion(["a"])
    finite = np.isfinite(motion.transforms(np.array([position]))).all(axis=1)
    assert finite.tolist() == [math.isfinite(position), False]


def test_of_a_repeated_name_the_first_one_is_used():
    motion = TransformTree(MIXED).motion(["b", "b"])
    row = motion.transforms(np.array([1.0, 2.0]))[0]
    assert np.allclose(matrix(row), expected(Frame("l2", "l3"), {"b": 1.0}))


def test_a_message_that_moves_nothing_has_no_transforms():
    assert TransformTree(MIXED).motion([]).transforms(np.array([])).shape == (0, 7)
