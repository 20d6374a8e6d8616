"""Cameras in the 3D view."""

import numpy as np

from arm_viewer.scene.cameras import frustum
from arm_viewer.snapshot import CameraView

WIDE = CameraView("optical", 320, 240, (200.0, 250.0), (100.0, 130.0))


def pixels(points: np.ndarray) -> np.ndarray:
    """Return where points of the optical frame are seen by WIDE (n, 2)."""
    matrix = np.array([[200.0, 0.0, 100.0], [0.0, 250.0, 130.0], [0.0, 0.0, 1.0]])
    seen = points @ matrix.T
    return seen[:, :2] / seen[:, 2:]


def test_the_edges_go_from_the_camera_through_the_corners_of_its_picture():
    edges = frustum(WIDE)[:4]
    assert (edges[:, 0] == 0.0).all()
    corners = [[0, 0], [320, 0], [320, 240], [0, 240]]
    np.testing.assert_allclose(pixels(edges[:, 1]), corners, atol=1e-3)
    assert (edges[:, 1, 2] > 0.0).all()


def test_the_mark_is_on_the_upper_edge():
    mark = pixels(frustum(WIDE)[-2:].reshape(-1, 3))
    assert mark[:, 1].min() < -10.0
    np.testing.assert_allclose(mark[[0, 3], 1], 0.0, atol=1e-3)
    np.testing.assert_allclose(mark[[1, 2], 0], 160.0, atol=1e-3)
