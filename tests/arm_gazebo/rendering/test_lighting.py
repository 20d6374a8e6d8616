"""Brightness of surfaces."""

import mujoco
import numpy as np
import pytest

from arm_gazebo.rendering.raycast_renderer import Lighting

UP = np.array([[0.0, 0.0, 1.0]])
ORIGIN = np.zeros((1, 3))


def brightness(light: str, point: np.ndarray = ORIGIN, normal: np.ndarray = UP, head: str = ""):
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco><visual><headlight {head or 'active=' + repr('0')}/></visual>"
        f"<worldbody>{light}</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    lighting = Lighting(model, data, np.array([0.0, 0.0, -1.0]))
    return lighting.brightness(np.asarray(point), np.asarray(normal))[0]


def test_no_light_is_dark():
    np.testing.assert_array_equal(brightness(""), 0.0)


def test_the_head_light_shines_along_the_view():
    head = 'ambient=".1 .2 .3" diffuse=".4 .4 .4"'
    np.testing.assert_allclose(brightness("", head=head), [0.5, 0.6, 0.7], rtol=1e-6)
    away = brightness("", normal=-UP, head=head)
    np.testing.assert_allclose(away, [0.1, 0.2, 0.3], rtol=1e-6)


@pytest.mark.parametrize(("angle_deg", "share"), [(0, 1.0), (60, 0.5), (120, 0.0)])
def test_a_directional_light_follows_lamberts_law(angle_deg, share):
    light = '<light type="directional" dir="0 0 -1" diffuse=".8 .8 .8"/>'
    angle = np.radians(angle_deg)
    tilted = np.array([[np.sin(angle), 0.0, np.cos(angle)]])
    np.testing.assert_allclose(brightness(light, normal=tilted), 0.8 * share, atol=1e-6)


def test_a_point_light_weakens_with_distance():
    light = '<light type="point" pos="0 0 2" diffuse="1 1 1" attenuation="0 0 1"/>'
    np.testing.assert_allclose(brightness(light), 0.25, rtol=1e-6)


@pytest.mark.parametrize(("x", "lit"), [(0.0, True), (1.9, False)])
def test_a_spot_light_ends_at_its_cone(x, lit):
    light = '<light type="spot" pos="0 0 2" dir="0 0 -1" cutoff="30" diffuse="1 1 1"/>'
    assert (brightness(light, point=np.array([[x, 0.0, 0.0]])).max() > 0.5) == lit


def test_a_light_that_is_off_gives_nothing():
    light = '<light active="false" type="directional" dir="0 0 -1" ambient="1 1 1"/>'
    np.testing.assert_array_equal(brightness(light), 0.0)
