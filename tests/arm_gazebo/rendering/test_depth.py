"""Depth from every backend of this machine, compared with rays and with plain geometry."""

from collections.abc import Callable
from dataclasses import replace

import mujoco
import numpy as np
import pytest

from arm_gazebo.camera.depth_image import PointGrid, mark_limits
from arm_gazebo.sensors.camera import CameraSensor

WORLD = """
<mujoco>
  <asset>
    <texture type="skybox" builtin="gradient" rgb1="1 0 0" rgb2="0 0 1" width="64" height="384"/>
  </asset>
  <worldbody>
    <light pos="0 0 4"/>
    <camera name="eye" pos="0 0 1" xyaxes="0 -1 0 0 0 1"/>
    <geom type="plane" size="0 0 1"/>
    <geom type="box" size=".1 1 .4" pos="2.6 0 1.2" rgba="1 0 0 1"/>
    <geom type="box" size=".1 .3 .3" pos="7 3 1" euler="20 30 10"/>
    <geom type="sphere" size=".01" pos=".06 .02 1.01"/>
  </worldbody>
</mujoco>
"""
EYE = CameraSensor("eye", "l", "f", 160, 120, near=0.1, far=20.0, depth_topics=("d",))
WALL = 2.5
MIDDLE = (60, 80)
CORNER = (0, 0)

Measure = Callable[[str], np.ndarray]


@pytest.fixture(scope="module")
def scene() -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = mujoco.MjModel.from_xml_string(WORLD)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


@pytest.fixture
def measure(see_by) -> Measure:
    """Return what measures the world with a backend."""

    def by(backend: str) -> np.ndarray:
        _picture, depth = see_by(backend, WORLD, EYE)
        mark_limits(depth, EYE)
        return depth

    return by


def test_a_wall_is_as_far_as_it_is(measure, backend):
    depth = measure(backend)
    # Along the camera's axis, so the same all over the wall: no cosine.
    assert depth[MIDDLE] == pytest.approx(WALL, abs=1e-4)
    assert depth[40, 130] == pytest.approx(WALL, abs=1e-4)


def test_the_sky_and_what_is_too_far_are_infinite(measure, backend):
    assert measure(backend)[CORNER] == np.inf


def test_what_is_too_near_is_minus_infinite(measure, backend):
    depth = measure(backend)
    # The little ball is nearer than the near clip, and hides the wall.
    assert np.isneginf(depth).sum() > 20
    assert not np.isnan(depth).any()


def test_every_pixel_agrees_with_its_own_ray(measure, scene, backend):
    model, data = scene
    depth = measure(backend)
    rotation = data.cam_xmat[0].reshape(3, 3)
    hit = np.array([-1], np.int32)
    for row, column in [(5, 140), (100, 20), (110, 150), (60, 20), (64, 40), (90, 80)]:
        x = (column + 0.5 - EYE.width / 2) / EYE.lens.fx
        y = (row + 0.5 - EYE.height / 2) / EYE.lens.fx
        ray = rotation @ np.array([x, -y, -1.0])
        along = mujoco.mj_ray(model, data, data.cam_xpos[0], ray, None, 1, -1, hit)
        expected = along if 0 < along <= EYE.far else np.inf
        assert depth[row, column] == pytest.approx(expected, abs=1e-3), (row, column)


def test_points_are_in_the_frame_of_their_header(measure):
    depth = measure("raycast")
    points = np.empty((EYE.height, EYE.width, 4), np.float32)
    forward_is_x = (0.0, 0.0, 1.0, 0.5, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0)
    PointGrid(replace(EYE, optics_in_frame=forward_is_x)).fill(points, depth, None)
    x, y, z = points[110, 80, :3]
    assert x == pytest.approx(0.5 + depth[110, 80], abs=1e-5)
    assert y == pytest.approx(0.0, abs=0.02)
    assert z == pytest.approx(-1.0, abs=1e-3)


def test_points_are_on_the_objects_and_have_their_colours(measure):
    depth = measure("raycast")
    picture = np.zeros((EYE.height, EYE.width, 3), np.uint8)
    picture[MIDDLE] = (255, 16, 1)
    points = np.empty((EYE.height, EYE.width, 4), np.float32)
    PointGrid(EYE).fill(points, depth, picture)
    middle = points[MIDDLE]
    # Half a pixel right of the axis and below it.
    half = 0.5 * WALL / EYE.lens.fx
    np.testing.assert_allclose(middle[:3], [half, half, WALL], atol=1e-4)
    assert middle[3:].view(np.uint32)[0] == 0xFF1001
    assert np.isnan(points[CORNER][:3]).all()
    floor = points[110, 80]
    assert floor[1] == pytest.approx(1.0, abs=1e-3)
