"""All render backends of this machine draw the same image, with objects at the right places."""

from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from arm_gazebo.rendering.raycast_renderer import RaycastRenderer
from arm_gazebo.sensors.camera import CameraSensor

Draw = Callable[[str, str, CameraSensor], np.ndarray]


@pytest.fixture
def draw(see_by) -> Draw:
    """Return what draws a model (MJCF) with a backend."""
    return lambda backend, mjcf, sensor: see_by(backend, mjcf, sensor)[0]


def sensor(width: int = 320, height: int = 240, **fields) -> CameraSensor:
    return CameraSensor("eye", "link", "frame", width=width, height=height, **fields)


def world(*elements: str, camera: str = 'pos="0 0 1" xyaxes="0 -1 0 0 0 1"') -> str:
    """A world with a camera that looks along x from 1 m above the ground."""
    return f"""
    <mujoco>
      <asset>
        <texture type="skybox" builtin="gradient" rgb1=".3 .5 .7" rgb2=".9 .9 .9" width="64"
                 height="384"/>
      </asset>
      <worldbody>
        <light pos="0 0 4" dir="0.3 0.2 -1" directional="true" diffuse=".6 .6 .6"/>
        <camera name="eye" {camera}/>
        {"".join(elements)}
      </worldbody>
    </mujoco>"""


FLOOR = '<geom type="plane" size="0 0 1" rgba=".5 .5 .5 1"/>'


def reddish(picture: np.ndarray) -> np.ndarray:
    wide = picture.astype(int)
    return wide[..., 0] > wide[..., 1] + 40


def bluish(picture: np.ndarray) -> np.ndarray:
    wide = picture.astype(int)
    return wide[..., 2] > wide[..., 0] + 40


@pytest.mark.parametrize(("width", "height", "hfov"), [(320, 240, 1.047), (400, 150, 1.8)])
def test_the_intrinsics_project_a_point_to_the_pixel_that_shows_it(
    draw, backend, width, height, hfov
):
    eye = sensor(width, height, hfov=hfov)
    f = eye.lens.fx
    for right, down, ahead in [(0.0, 0.0, 2.0), (0.5, 0.3, 2.0), (-0.6, -0.2, 1.5)]:
        # The camera looks along x: right of it is -y, below it is -z.
        ball = f'<geom type="sphere" size="0.05" pos="{ahead} {-right} {1 - down}" rgba="1 0 0 1"/>'
        rows, columns = np.nonzero(reddish(draw(backend, world(ball), eye)))
        assert rows.size > 20
        assert np.mean(columns) + 0.5 == pytest.approx(width / 2 + f * right / ahead, abs=1.0)
        assert np.mean(rows) + 0.5 == pytest.approx(height / 2 + f * down / ahead, abs=1.0)


def test_a_picture_may_be_smaller_than_that_of_the_self_test(draw, backend):
    ball = '<geom type="sphere" size="0.3" pos="2 0 1" rgba="1 0 0 1"/>'
    rows, columns = np.nonzero(reddish(draw(backend, world(ball), sensor(32, 24))))
    assert rows.size > 20
    assert (np.mean(columns), np.mean(rows)) == pytest.approx((15.5, 11.5), abs=1.0)


def test_the_horizon_is_at_the_right_height(draw, backend):
    picture = draw(backend, world(FLOOR), sensor())
    grey = np.ptp(picture.astype(int), axis=2) < 8
    assert not grey[:115].any()
    assert grey[130:].all()


def test_the_first_row_is_the_top(draw, backend):
    above = '<geom type="sphere" size="0.3" pos="2 0 1.5" rgba="1 0 0 1"/>'
    rows, _ = np.nonzero(reddish(draw(backend, world(above), sensor())))
    assert rows.mean() < 120


def test_collision_shapes_are_not_seen(draw, backend):
    hidden = '<geom type="sphere" size="0.3" pos="2 0 1" rgba="1 0 0 1" group="3"/>'
    assert not reddish(draw(backend, world(hidden), sensor())).any()


def test_transparent_shapes_are_not_seen(draw, backend):
    hidden = '<geom type="sphere" size="0.3" pos="2 0 1" rgba="1 0 0 0"/>'
    assert not reddish(draw(backend, world(hidden), sensor())).any()


@pytest.mark.parametrize(("near", "seen"), [(0.1, True), (1.5, False)])
def test_what_is_nearer_than_the_near_clip_is_looked_through(draw, backend, near, seen):
    balls = (
        '<geom type="sphere" size="0.2" pos="1 0 1" rgba="1 0 0 1"/>',
        '<geom type="sphere" size="0.8" pos="4 0 1" rgba="0 0 1 1"/>',
    )
    picture = draw(backend, world(*balls), sensor(near=near))
    assert reddish(picture)[120, 160] == seen
    assert bluish(picture)[120, 160] != seen


def test_what_is_farther_than_the_far_clip_is_not_seen(draw, backend):
    ball = '<geom type="sphere" size="0.8" pos="4 0 1" rgba="1 0 0 1"/>'
    assert not reddish(draw(backend, world(ball), sensor(far=2.0))).any()


def test_a_camera_inside_a_body_sees_out(draw, backend):
    shell = '<geom type="box" size="0.05 0.05 0.05" pos="0 0 1" rgba="1 0 0 1"/>'
    ball = '<geom type="sphere" size="0.4" pos="2 0 1" rgba="0 0 1 1"/>'
    picture = draw(backend, world(shell, ball), sensor())
    assert not reddish(picture).any()
    assert bluish(picture)[120, 160]


def test_a_colour_of_a_material_counts(draw, backend):
    ball = '<geom type="sphere" size="0.4" pos="2 0 1" material="red"/>'
    mjcf = world(ball).replace("<asset>", '<asset><material name="red" rgba="1 0 0 1"/>')
    assert reddish(draw(backend, mjcf, sensor()))[120, 160]


STILL_LIFE = world(
    '<geom type="plane" size="0 0 1" material="matte"/>',
    '<geom type="box" size=".2 .2 .2" pos="2 .5 .2" euler="0 0 30" rgba=".8 .2 .2 1"/>',
    '<geom type="cylinder" size=".15 .2" pos="1.6 0 .2" rgba=".2 .6 .2 1"/>',
    '<geom type="sphere" size=".2" pos="2 -.6 .2" rgba=".2 .3 .8 1"/>',
    '<geom type="capsule" size=".1 .2" pos="3 .2 .6" euler="50 0 20" rgba=".8 .7 .2 1"/>',
    '<geom type="ellipsoid" size=".3 .1 .2" pos="3 -.5 1" rgba=".3 .7 .7 1"/>',
    camera='pos="0 0 1" xyaxes="0 -1 0 0.35 0 0.94"',
).replace("<asset>", '<asset><material name="matte" rgba=".5 .5 .5 1" specular="0"/>')


@pytest.mark.parametrize(("width", "height"), [(320, 240), (640, 480)])
def test_rays_and_opengl_show_the_same(draw, gl_backend, width, height):
    eye = sensor(width, height)
    by_gl = draw(gl_backend, STILL_LIFE, eye).astype(int)
    by_rays = draw("raycast", STILL_LIFE, eye).astype(int)
    difference = np.abs(by_gl - by_rays).max(axis=2)
    # Highlights are OpenGL's alone, and edges may be a pixel off.
    assert np.median(difference) <= 2
    assert np.mean(difference > 30) < 0.02
    np.testing.assert_allclose(by_gl.mean(axis=(0, 1)), by_rays.mean(axis=(0, 1)), atol=3)


def test_rays_give_the_same_picture_each_time(see_anew):
    first, second = (see_anew(STILL_LIFE, sensor())[0] for _ in range(2))
    np.testing.assert_array_equal(first, second)


def test_rays_leave_the_model_as_it_was():
    model = mujoco.MjModel.from_xml_string(
        world('<geom type="box" size="0.05 0.05 0.05" pos="0 0 1"/>', FLOOR)
    )
    before = model.geom_group.copy()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    renderer = RaycastRenderer()
    renderer.set_model(model)
    renderer.render(data, sensor(), np.zeros((240, 320, 3), np.uint8))
    np.testing.assert_array_equal(model.geom_group, before)
