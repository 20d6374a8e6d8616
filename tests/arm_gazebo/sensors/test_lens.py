"""The lens model, judged by OpenCV."""

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_gazebo.sensors.camera import UNDISTORTED, Lens

SIZE = (640, 480)
LENSES = {
    "pinhole": Lens(700, 600, 300, 250),
    "skewed": Lens(600, 600, 320, 240, 30),
    "cushion": Lens(700, 600, 300, 250, 0, (0.1, 0, 0, 0, 0)),
    "barrel": Lens(400, 400, 320, 240, 0, (-0.3, 0.09, 0, 0, 0)),
    "decentred": Lens(400, 410, 310, 250, 3, (-0.3, 0.09, 0.01, -0.02, 0.001)),
    "principal point outside": Lens(500, 500, -100, 600, 0, (0.05, 0, 0, 0, 0)),
}


@pytest.mark.parametrize("lens", LENSES.values(), ids=LENSES)
def test_the_ray_of_a_pixel_is_projected_to_its_centre(lens):
    rays = lens.rays(*SIZE)
    assert rays.shape == (480, 640, 2)
    points = np.concatenate([rays, np.ones((480, 640, 1))], axis=2).reshape(-1, 3)
    k = lens.matrix
    k[0, 1] = 0.0  # OpenCV knows no skew.
    zero = np.zeros(3)
    pixels, _ = cv2.projectPoints(points, zero, zero, k, np.array(lens.distortion, float))
    pixels = pixels.reshape(480, 640, 2)
    pixels[..., 0] += lens.skew * (pixels[..., 1] - lens.cy) / lens.fy
    columns, rows = np.meshgrid(np.arange(640) + 0.5, np.arange(480) + 0.5)
    np.testing.assert_allclose(pixels[..., 0], columns, atol=1e-8)
    np.testing.assert_allclose(pixels[..., 1], rows, atol=1e-8)
    assert lens.problem(*SIZE) == ""


@pytest.mark.parametrize("lens", LENSES.values(), ids=LENSES)
def test_the_outline_encloses_all_rays(lens):
    rays, outline = lens.rays(*SIZE).reshape(-1, 2), lens.outline(*SIZE)
    assert (outline.min(axis=0) < rays.min(axis=0)).all()
    assert (outline.max(axis=0) > rays.max(axis=0)).all()


def test_k1_alone_moves_a_ray_by_the_cube_of_its_radius():
    lens = Lens(100, 100, 0, 0, 0, (0.1, 0, 0, 0, 0))
    # x / z = 1 appears at 1 + 0.1.
    assert lens.rays(220, 1)[0, 109, 0] == pytest.approx(0.996, abs=1e-3)


def test_a_model_that_folds_back_before_the_corner_is_named_with_its_radius():
    lens = Lens(330, 330, 320, 240, 0, (-0.35, 0.12, 0, 0, -0.02))
    assert lens.problem(*SIZE) == (
        "it folds back 294 pixels from the principal point (at x / z = 1.55), but the farthest "
        "corner of the picture is 400 pixels away"
    )
    # The middle of the same picture is fine.
    assert Lens(330, 330, 200, 150, 0, lens.distortion).problem(400, 300) == ""


def test_the_radius_is_where_two_rays_meet():
    k1 = -0.2
    lens = Lens(1000, 1000, 0, 0, 0, (k1, 0, 0, 0, 0))
    turn = (1 / (-3 * k1)) ** 0.5
    reached = 1000 * (turn + k1 * turn**3)
    assert f"folds back {reached:.0f} pixels" in lens.problem(900, 900)
    assert lens.problem(600, 600) == ""
    assert lens.problem(int(reached / 2**0.5) - 1, int(reached / 2**0.5) - 1) == ""


coefficients = st.floats(-2, 2) | st.floats(-0.1, 0.1) | st.just(0.0)


@given(
    st.tuples(st.floats(1, 1e6), st.floats(1, 1e6), st.floats(-1e5, 1e5), st.floats(-1e5, 1e5)),
    st.tuples(*(coefficients,) * 5),
)
def test_a_lens_is_refused_or_its_rays_meet_their_pixels(intrinsics, distortion):
    lens = Lens(*intrinsics, 0.0, distortion)
    if lens.problem(16, 12):
        return
    x, y = lens.rays(16, 12).reshape(-1, 2).T
    points = np.stack([x, y, np.ones(len(x))], axis=1)
    plain = np.eye(3)
    pixels, _ = cv2.projectPoints(points, np.zeros(3), np.zeros(3), plain, np.array(distortion))
    columns, rows = np.meshgrid(np.arange(16) + 0.5, np.arange(12) + 0.5)
    wanted = np.stack([(columns - lens.cx) / lens.fx, (rows - lens.cy) / lens.fy], axis=2)
    np.testing.assert_allclose(pixels.reshape(-1, 2), wanted.reshape(-1, 2), rtol=1e-9, atol=1e-9)


def test_a_tangential_part_that_cannot_be_undone_is_named():
    lens = Lens(400, 410, 310, 250, 0, (0, 0, 1, 0, 0))
    assert "it cannot be undone 244 pixels" in lens.problem(*SIZE)


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (5, 1)])
def test_the_smallest_pictures(size):
    lens = Lens(10, 10, size[0] / 2, size[1] / 2, 0, (-0.1, 0, 0, 0, 0))
    assert lens.problem(*size) == ""
    assert lens.rays(*size).shape == (size[1], size[0], 2)


def test_a_lens_without_distortion_is_a_pinhole():
    assert Lens(1, 1, 0, 0).distortion == UNDISTORTED
    assert Lens(1, 1, 0, 0).is_pinhole
    assert not Lens(1, 1, 0, 0, 0.1).is_pinhole
    assert not Lens(1, 1, 0, 0, 0, (0, 0, 0, 0, 1e-9)).is_pinhole
