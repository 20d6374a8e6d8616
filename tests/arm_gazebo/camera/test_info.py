"""The intrinsic matrices."""

import numpy as np
import pytest

from arm_gazebo.ros.camera_publisher import info_message
from arm_gazebo.sensors.camera import CameraSensor

SENSOR = CameraSensor("c", "l", "f", width=320, height=240, hfov=1.047)


def test_the_camera_matrix_of_the_arms_camera():
    k = np.reshape(info_message(SENSOR).k, (3, 3))
    expected = [[277.191, 0, 160], [0, 277.191, 120], [0, 0, 1]]
    assert k == pytest.approx(np.array(expected), abs=1e-3)


def test_a_point_at_the_edge_of_the_field_of_view_is_at_the_edge_of_the_picture():
    p = np.reshape(info_message(SENSOR).p, (3, 4))
    u, _v, w = p @ [np.tan(SENSOR.hfov / 2) * 2.0, 0.0, 2.0, 1.0]
    assert u / w == pytest.approx(320)


def test_there_is_no_distortion_and_no_rectification():
    info = info_message(SENSOR)
    assert info.d.tolist() == [0.0] * 5
    np.testing.assert_array_equal(np.reshape(info.r, (3, 3)), np.eye(3))
