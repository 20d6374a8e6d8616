"""The meshes of the ROSMASTER X3: as large as the robot, its wheels alike on both sides."""

import numpy as np
import pytest
from mesh_measures import bounds, visuals

from arm_description import Robot, expand_xacro, parse_urdf, resolve_uri

URDF = resolve_uri("package://yahboom_rosmaster_description/urdf")
BOUNDS = {
    "base_link": ((-175.91, -82.44, -54.03), (116.5, 82.59, 190.52)),
    "front_left_wheel_link": ((-32.3, -20.05, -32.3), (32.3, 15.15, 32.3)),
    "back_right_wheel_link": ((-32.3, -15.2, -32.3), (32.3, 20.0, 32.3)),
    "cam_1_link": ((-21.85, -45.0, -12.5), (3.2, 45.0, 12.5)),
    "imu_link": ((-19.495, -18.925, -6.69), (19.495, 18.925, 6.69)),
}
"""Bounding boxes in mm, in the link's frame."""


@pytest.fixture(scope="module")
def robot() -> Robot:
    return parse_urdf(expand_xacro(URDF / "robots" / "rosmaster_x3.urdf.xacro"))


@pytest.mark.parametrize(("link", "box"), BOUNDS.items())
def test_a_link_is_as_large_as_the_original(robot, link, box):
    assert 1000 * bounds(robot, link) == pytest.approx(np.array(box), abs=1.5)


@pytest.mark.parametrize("end", ["front", "back"])
def test_the_right_wheel_is_the_left_one_s_mirror_image(robot, end):
    left = visuals(robot, f"{end}_left_wheel_link")
    right = visuals(robot, f"{end}_right_wheel_link")

    for ours, theirs in zip(left, right, strict=True):
        (x0, y0, z0), (x1, y1, z1) = ours.bounds
        assert theirs.bounds == pytest.approx(np.array([[x0, -y1, z0], [x1, -y0, z1]]), abs=2e-5)
        assert theirs.volume == pytest.approx(ours.volume, rel=1e-3)


def test_the_barrels_on_top_point_to_the_middle_of_the_robot(robot):
    for wheel in ("front_left", "front_right", "back_left", "back_right"):
        rollers, _ = visuals(robot, f"{wheel}_wheel_link")
        # So near the top a level cut meets one barrel alone.
        cut = rollers.section([0, 0, 1], [0, 0, 0.032])
        assert cut is not None
        x, y, _ = cut.vertices[(np.abs(cut.vertices[:, :2]) < 0.006).all(axis=1)].T
        pointing = 1.0 if wheel in ("front_left", "back_right") else -1.0
        assert np.polyfit(x, y, 1)[0] * pointing > 0.3, wheel
