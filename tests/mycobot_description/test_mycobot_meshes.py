"""The myCobot's meshes: like the original's in size, its gripper alike on both sides."""

import numpy as np
import pytest
import trimesh
from mesh_measures import bounds, visuals

from arm_description import Robot, expand_xacro, parse_urdf, resolve_uri

URDF = resolve_uri("package://mycobot_description/urdf")

BOUNDS = {
    "link2": ((-24.0, -36.58, -64.14), (24.0, 23.96, 22.92)),
    "link3": ((-132.0, -24.0, 29.84), (24.0, 24.0, 85.28)),
    "link4": ((-115.16, -21.6, -22.4), (21.64, 21.6, 35.4)),
    "link5": ((-19.29, -36.64, -33.7), (19.29, 19.71, 19.08)),
    "link6": ((-19.2, -21.6, -38.0), (19.2, 35.1, 19.12)),
    "link6_flange": ((-19.2, -19.2, -12.0), (19.2, 19.2, 1.7)),
    "gripper_base": ((-29.0, -32.32, -18.2), (29.0, 29.91, 37.7)),
    "gripper_left1": ((-5.68, -4.98, -18.53), (19.5, 53.22, 2.13)),
    "gripper_left2": ((-32.44, -4.67, -18.2), (3.48, 19.62, 1.8)),
    "gripper_left3": ((-32.19, -14.23, -3.2), (12.84, 19.3, 1.8)),
}
"""Bounding boxes of the original's visuals in mm, in the link's frame.

Here the axles of the gripper's base reach down through its levers, and the pads to where they
touch.
"""


@pytest.fixture(scope="module")
def robot() -> Robot:
    return parse_urdf(expand_xacro(URDF / "robots" / "mycobot_280.urdf.xacro"))


@pytest.mark.parametrize(("link", "box"), BOUNDS.items())
def test_a_link_is_as_large_as_the_original(robot, link, box):
    assert 1000 * bounds(robot, link) == pytest.approx(np.array(box), abs=2.0)


MESHES = resolve_uri("package://mycobot_description/meshes/mycobot_280")


def test_every_link_with_a_shape_has_its_own_files(robot):
    shaped = {link.name for link in robot.links if link.visuals}
    assert {path.stem for path in (MESHES / "visual").glob("*.dae")} == shaped
    assert {path.stem for path in (MESHES / "collision").glob("*.stl")} == shaped


@pytest.mark.parametrize("link", BOUNDS)
def test_the_dae_of_a_link_has_its_pieces_in_their_colours(robot, link):
    coloured = trimesh.load_scene(MESHES / "visual" / f"{link}.dae")
    assert coloured.bounds == pytest.approx(bounds(robot, link), abs=2e-6)
    colours = {tuple(m.visual.material.main_color) for m in coloured.geometry.values()}
    materials = [visual.material.rgba for visual in robot.link(link).visuals]
    assert colours == {tuple(round(255 * part) for part in rgba) for rgba in materials}


@pytest.mark.parametrize("number", [1, 2, 3])
def test_the_right_side_of_the_gripper_is_the_left_ones_mirror_image(robot, number):
    left = visuals(robot, f"gripper_left{number}")
    right = visuals(robot, f"gripper_right{number}")

    for ours, theirs in zip(left, right, strict=True):
        (x0, *low), (x1, *high) = ours.bounds
        assert theirs.bounds == pytest.approx(np.array([[-x1, *low], [-x0, *high]]), abs=1e-6)
