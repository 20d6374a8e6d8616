"""Poses of all links in the physics, compared with yourdfpy."""

import mujoco
import numpy as np
import pytest
from lxml import etree

from arm_description.urdf.parser import parse_urdf

LIMIT = '<limit lower="-3" upper="3" effort="20" velocity="2"/>'


def vector(random, scale=1.0):
    return " ".join(f"{value:.4f}" for value in random.uniform(-scale, scale, 3))


def unit_vector(random):
    """Return an axis of length 1: yourdfpy takes a slide's length for its stride."""
    direction = random.normal(size=3)
    return " ".join(repr(float(value)) for value in direction / np.linalg.norm(direction))


def serial(seed, dof, kinds=("revolute",)):
    """Return a chain with random origins and axes, each third joint followed by a fixed one."""
    random = np.random.default_rng(seed)
    parts, parent = ['<link name="base"/>'], "base"
    for index in range(dof):
        origin = f'<origin xyz="{vector(random, 0.3)}" rpy="{vector(random, 3.1)}"/>'
        axis = f'<axis xyz="{unit_vector(random)}"/>'
        ends = f'<parent link="{parent}"/><child link="l{index}"/>'
        parts.append(
            f'<link name="l{index}"/><joint name="j{index}" type="{kinds[index % len(kinds)]}">'
            f"{ends}{origin}{axis}{LIMIT}</joint>"
        )
        parent = f"l{index}"
        if index % 3 == 2:
            parts.append(
                f'<link name="f{index}"/><joint name="fixed{index}" type="fixed">'
                f'<parent link="{parent}"/><child link="f{index}"/>{origin}</joint>'
            )
            parent = f"f{index}"
    return parts, parent


def robot(parts):
    return f'<robot name="r">{"".join(parts)}</robot>'


def gripper():
    """Return an arm with fingers that follow each other, with offsets, over a chain."""
    parts, hand = serial(11, 4)
    followed = "j3"
    for name, multiplier, offset in (("a", -1.0, 0.1), ("b", 0.5, -0.2), ("c", 2.0, 0.0)):
        parts.append(
            f'<link name="{name}"/><joint name="{name}" type="revolute"><parent link="{hand}"/>'
            f'<child link="{name}"/><origin xyz="0 0.1 0"/><axis xyz="1 0 0"/>{LIMIT}'
            f'<mimic joint="{followed}" multiplier="{multiplier}" offset="{offset}"/></joint>'
        )
        followed = name
    return robot(parts)


ROBOTS = {
    **{f"seven joints {seed}": robot(serial(seed, 7)[0]) for seed in range(4)},
    "six joints": robot(serial(5, 6)[0]),
    "slides and wheels": robot(serial(6, 7, ("prismatic", "continuous", "revolute"))[0]),
    "chained mimics": gripper(),
}


def second_opinion(text):
    """Return yourdfpy's robot with every joint free: it does not solve chains of mimics."""
    import yourdfpy  # two seconds of every worker that collects this file, if above

    root = etree.fromstring(text)
    etree.strip_elements(root, "mimic")
    return yourdfpy.URDF(
        yourdfpy.URDF._parse_robot(xml_element=root), load_meshes=False, load_collision_meshes=False
    )


@pytest.mark.parametrize("name", ROBOTS)
def test_links_are_where_yourdfpy_puts_them(parts, name):
    text = ROBOTS[name]
    built, oracle = parts.build(text), second_opinion(text)
    mimics = [joint for joint in parse_urdf(text).joints if joint.mimic is not None]
    data = mujoco.MjData(built.model)
    random = np.random.default_rng(1)
    free = list(oracle.actuated_joint_names)
    for _ in range(20):
        positions = dict(zip(free, random.uniform(-1.0, 1.0, len(free)), strict=True))
        for joint in mimics:
            leader = positions[joint.mimic.joint]
            positions[joint.name] = joint.mimic.multiplier * leader + joint.mimic.offset
        oracle.update_cfg(positions)
        for joint, position in positions.items():
            data.qpos[built.joints[joint].qpos_address] = position
        mujoco.mj_kinematics(built.model, data)
        for link, body in built.bodies.items():
            expected = oracle.get_transform(link, "base")
            assert np.allclose(data.xpos[body], expected[:3, 3], atol=1e-9)
            assert np.allclose(data.xmat[body].reshape(3, 3), expected[:3, :3], atol=1e-9)
