import mujoco
import numpy as np
import pytest
from robots import joint, link, robot

from arm_description import forward_kinematics, parse_urdf
from arm_planning.errors import PlanningError
from arm_planning.kinematic_tree import KinematicTree, kinematic_tree, position_map

ARM = robot(
    *(link(name) for name in ("base", "world", "hand", "finger", "thumb", "tail")),
    joint("turn", "base", "world", xyz="0.1 0 0.2", axis="0 0.6 0.8"),
    joint("slide", "world", "hand", xyz="0 0.3 0", axis="1 0 0", kind="prismatic"),
    joint("grip", "hand", "finger", xyz="0 0 0.1", axis="0 0 1"),
    joint(
        "follow",
        "finger",
        "thumb",
        "<mimic joint='grip' multiplier='-2' offset='0.1'/>",
        xyz="1 0 0",
    ),
    joint("mount", "base", "tail", xyz="1 2 3", kind="fixed"),
)
JOINTS = ("turn", "slide", "grip")


def poses(tree: KinematicTree, positions: np.ndarray) -> dict[str, np.ndarray]:
    model = tree.spec.compile()
    data = mujoco.MjData(model)
    for part, position in zip(tree.joints.values(), positions, strict=True):
        data.qpos[model.jnt_qposadr[part.id]] = position
    mujoco.mj_kinematics(model, data)
    return {
        name: np.column_stack([data.xmat[body.id].reshape(3, 3), data.xpos[body.id]])
        for name, body in tree.bodies.items()
    }


def test_links_are_where_forward_kinematics_puts_them():
    description = parse_urdf(ARM)
    tree = kinematic_tree(description)
    q = np.array([0.4, -0.2, 0.7])
    positions = position_map(description, tuple(tree.joints), JOINTS, {})(q)
    expected = forward_kinematics(description, dict(zip(JOINTS, q.tolist(), strict=True)))
    found = poses(tree, positions)
    assert found.keys() == expected.keys()
    for name, pose in found.items():
        assert pose == pytest.approx(expected[name][:3], abs=1e-12), name


def test_only_what_carries_the_tips_is_kept():
    tree = kinematic_tree(parse_urdf(ARM), ("hand", "tail"))
    assert set(tree.bodies) == {"base", "world", "hand", "tail"}
    assert set(tree.joints) == {"turn", "slide"}


def test_joints_that_are_built_in_are_none():
    description = parse_urdf(ARM)
    fixed = {"turn": 0.4, "slide": -0.2}
    tree = kinematic_tree(description, built_in=fixed)
    assert set(tree.joints) == {"grip", "follow"}
    expected = forward_kinematics(description, {**fixed, "grip": 0.7})
    for name, pose in poses(tree, np.array([0.7, -1.3])).items():
        assert pose == pytest.approx(expected[name][:3], abs=1e-12), name


def test_joints_that_do_not_vary_stay_where_they_are_and_mimics_follow_them():
    positions = position_map(parse_urdf(ARM), ("turn", "grip", "follow"), ("turn",), {"grip": 0.5})
    assert positions(np.array([0.3])) == pytest.approx((0.3, 0.5, -0.9))


def test_a_given_position_of_a_mimic_joint_counts():
    positions = position_map(parse_urdf(ARM), ("follow",), ("turn",), {"grip": 0.5, "follow": 0.2})
    assert positions(np.array([0.3])) == pytest.approx((0.2,))


def test_too_many_links_are_refused_at_once():
    links = [link(f"l{n}") for n in range(1001)]
    joints = [joint(f"j{n}", f"l{n}", f"l{n + 1}") for n in range(1000)]
    with pytest.raises(PlanningError, match="has 1001 links; planning takes 1000"):
        kinematic_tree(parse_urdf(robot(*links, *joints)))
