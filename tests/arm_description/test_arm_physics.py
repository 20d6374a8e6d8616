"""The arm's masses, inertias and collision shapes."""

import itertools
from functools import cache

import mujoco
import numpy as np
import pytest

from arm_description import (
    Box,
    Cylinder,
    Link,
    Pose,
    Robot,
    expand_xacro,
    forward_kinematics,
    parse_urdf,
    resolve_uri,
)

JOINTS = ("j0", "j1", "j2", "j3")
HOLLOW_FRAMES = {"dyn2_r", "dyn3_r", "dyn4_r", "dyn5_r"}

POSES = [
    (0.0, 0.0, 0.0, 0.0),
    (0.0, 0.5, 0.5, 1.0),
    (1.0, 0.5, 0.1, 0.5),
    (1.0, 0.5, 0.0, 0.0),
    (0.4, -0.1, 0.5, 0.4),
]
"""Upright, and the originals' initial and commanded poses, in rad."""

POSE_THAT_TOUCHES = (1.0, 2.0, -1.0, -2.0)
"""One original's initial pose: the servo of j3 touches the wrist bracket that turns about it."""


@cache
def arm() -> Robot:
    path = resolve_uri("package://arm_description/urdf/arm.urdf.xacro")
    return parse_urdf(expand_xacro(path, {"base": "free", "camera": "none"}))


def solid_links() -> list[Link]:
    return [link for link in arm().links if link.inertial is not None]


def rigid_bodies(robot: Robot) -> dict[str, str]:
    """Return for each link the first link of the rigid body that it belongs to."""
    body = {robot.root: robot.root}
    for joint in robot.joints_in_tree_order:
        body[joint.child] = body[joint.parent] if joint.type == "fixed" else joint.child
    return body


def collision_model(positions) -> tuple[mujoco.MjModel, list[str]]:
    """Return all collision shapes, fixed in space at a pose, and the link of each."""
    spec, links = mujoco.MjSpec(), []
    poses = forward_kinematics(arm(), dict(zip(JOINTS, positions, strict=True)))
    for link in arm().links:
        for collision in link.collisions:
            pose = poses[link.name] @ collision.origin.matrix()
            quat = np.zeros(4)
            mujoco.mju_mat2Quat(quat, pose[:3, :3].flatten())
            kind, size = shape(collision.geometry)
            spec.worldbody.add_geom(type=kind, size=size, pos=pose[:3, 3], quat=quat)
            links.append(link.name)
    return spec.compile(), links


def shape(geometry: Box | Cylinder) -> tuple[mujoco.mjtGeom, list[float]]:
    if isinstance(geometry, Box):
        return mujoco.mjtGeom.mjGEOM_BOX, [length / 2 for length in geometry.size]
    return mujoco.mjtGeom.mjGEOM_CYLINDER, [geometry.radius, geometry.length / 2, 0.0]


def distances(positions) -> dict[tuple[str, str], float]:
    """Return the distance in m between each two links of different bodies, 0.05 at most."""
    model, links = collision_model(positions)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    body = rigid_bodies(arm())
    result: dict[tuple[str, str], float] = {}
    for first, second in itertools.combinations(range(model.ngeom), 2):
        pair = (links[first], links[second])
        if body[pair[0]] != body[pair[1]]:
            distance = mujoco.mj_geomDistance(model, data, first, second, 0.05, None)
            result[pair] = min(distance, result.get(pair, 0.05))
    return result


def corners(link: Link) -> np.ndarray:
    """Return the corners of all collision shapes in the link's frame, (n, 3)."""
    points = []
    for collision in link.collisions:
        half = np.array(box_around(collision.geometry)) / 2
        for signs in itertools.product((-1, 1), repeat=3):
            points.append(collision.origin.matrix() @ np.append(half * signs, 1.0))
    return np.array(points)[:, :3]


def box_around(geometry: Box | Cylinder) -> tuple[float, float, float]:
    if isinstance(geometry, Box):
        return geometry.size
    return (2 * geometry.radius, 2 * geometry.radius, geometry.length)


def test_thirteen_links_weigh_100_g_each():
    assert [link.inertial.mass for link in solid_links()] == [0.1] * 13


def test_only_the_frames_that_servos_turn_weigh_nothing():
    names = {link.name for link in arm().links if link.inertial is None}

    assert names == HOLLOW_FRAMES


@pytest.mark.parametrize("link", solid_links(), ids=lambda link: link.name)
def test_an_inertia_is_one_that_a_body_can_have(link):
    ixx, ixy, ixz, iyy, iyz, izz = link.inertial.inertia
    moments = np.linalg.eigvalsh([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])

    assert moments[0] > 0
    assert moments[0] + moments[1] >= moments[2] * (1 - 1e-6)


@pytest.mark.parametrize("link", solid_links(), ids=lambda link: link.name)
def test_an_inertia_fits_the_size_of_the_link(link):
    size = np.ptp(corners(link), axis=0)
    ixx, _, _, iyy, _, izz = link.inertial.inertia

    # A solid box has 1/12 of this, all mass at its corners 1/4.
    for moment, (a, b) in zip((ixx, iyy, izz), (size[[1, 2]], size[[0, 2]], size[:2]), strict=True):
        assert 0.02 < moment / (link.inertial.mass * (a**2 + b**2)) < 0.25


@pytest.mark.parametrize("link", solid_links(), ids=lambda link: link.name)
def test_the_centre_of_mass_is_inside_the_link(link):
    points = corners(link)
    centre = link.inertial.origin.xyz

    assert np.all(points.min(axis=0) < centre)
    assert np.all(centre < points.max(axis=0))
    assert link.inertial.origin.rpy == Pose().rpy


def test_the_centre_of_mass_of_the_upright_arm():
    poses = forward_kinematics(arm(), {})

    centres = [poses[link.name] @ (*link.inertial.origin.xyz, 1.0) for link in solid_links()]

    # 0.2323 m is the height where every mesh's box would have its mass in the middle.
    assert np.mean(centres, axis=0)[:3] == pytest.approx((0.0005, 0.001, 0.2323), abs=0.006)


def test_the_foot_is_flat_and_31_mm_below_its_link():
    foot = arm().link("base_link")
    plate = foot.collisions[0]

    assert plate.origin.rpy == (0.0, 0.0, 0.0)
    assert plate.origin.xyz[2] - plate.geometry.size[2] / 2 == pytest.approx(-0.0313, abs=1e-9)
    assert corners(foot)[:, 2].min() == pytest.approx(-0.0313, abs=1e-9)


@pytest.mark.parametrize("positions", POSES, ids=str)
def test_no_body_overlaps_another(positions):
    overlapping = {pair: d for pair, d in distances(positions).items() if d < 0}

    assert overlapping == {}


def test_where_one_originals_initial_pose_touches():
    overlapping = {pair: d for pair, d in distances(POSE_THAT_TOUCHES).items() if d < 0}

    assert overlapping == {("dyn4", "wrist"): pytest.approx(-0.0015, abs=2e-4)}


def test_nothing_reaches_below_the_floor_in_any_pose():
    for positions in [*POSES, POSE_THAT_TOUCHES]:
        poses = forward_kinematics(arm(), dict(zip(JOINTS, positions, strict=True)))
        for link in arm().links:
            if link.collisions:
                points = corners(link) @ poses[link.name][:3, :3].T + poses[link.name][:3, 3]
                assert points[:, 2].min() > -0.0313 - 1e-9, (link.name, positions)
