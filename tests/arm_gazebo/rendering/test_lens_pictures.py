"""Pictures, depth and points of cameras with intrinsics and distortion, judged by OpenCV."""

from dataclasses import replace

import cv2
import mujoco
import numpy as np
import pytest

from arm_gazebo.camera.depth_image import PointGrid
from arm_gazebo.rendering.pinhole_view import PinholeView
from arm_gazebo.robot.part import add_cameras
from arm_gazebo.ros.camera_publisher import info_message
from arm_gazebo.sensors.camera import CameraSensor

COLUMNS, ROWS, SQUARE = 6, 4, 0.06
"""Inner corners of the board, and the side of a square in m."""
CORNERS = np.array(
    [
        ((i - (COLUMNS - 1) / 2) * SQUARE, (j - (ROWS - 1) / 2) * SQUARE, 0.0)
        for j in range(ROWS)
        for i in range(COLUMNS)
    ]
)
MIDDLE = np.array([0.0, 0.02, 0.55])
"""The middle of the board in the optical frame, in m."""
TURNED = (0.2, -0.2, 0.3)
"""How the board is turned, as a rotation vector in rad."""
UPWARDS = np.diag([1.0, -1.0, -1.0])
"""From the optical frame to a MuJoCo camera's axes, which are the world's."""

WIDE = CameraSensor("eye", "link", "frame", 640, 480, 1.0756, far=20.0, depth_topics=("d",))
LENSES = {
    "pinhole": replace(WIDE, intrinsics=(700.0, 600.0, 300.0, 250.0, 0.0)),
    "skewed": replace(WIDE, intrinsics=(600.0, 600.0, 320.0, 240.0, 40.0)),
    "cushion": replace(
        WIDE, intrinsics=(700.0, 600.0, 300.0, 250.0, 0.0), distortion=(0.1, 0.0, 0.0, 0.0, 0.0)
    ),
    "barrel": replace(
        WIDE, intrinsics=(450.0, 450.0, 330.0, 235.0, 0.0), distortion=(-0.3, 0.09, 0.0, 0.0, 0.0)
    ),
    "decentred": replace(
        WIDE,
        intrinsics=(560.0, 550.0, 310.0, 250.0, 0.0),
        distortion=(-0.05, 0.06, 0.02, -0.015, 0.003),
    ),
}
lenses = pytest.mark.parametrize("lens", LENSES)


def board() -> str:
    """Return a world with a chess board before the camera; bodies have MuJoCo's camera axes."""
    rotation = UPWARDS @ cv2.Rodrigues(np.array(TURNED))[0]
    x, y = rotation[:, 0], rotation[:, 1]
    middle, quat = UPWARDS @ MIDDLE, np.zeros(4)
    mujoco.mju_mat2Quat(quat, np.stack([x, y, np.cross(x, y)], axis=1).ravel())
    half = SQUARE / 2
    squares = "".join(
        f'<geom type="box" size="{half} {half} .0001" rgba=".02 .02 .02 1" '
        f'pos="{(i - COLUMNS / 2) * SQUARE} {(j - ROWS / 2) * SQUARE} .0001"/>'
        for i in range(COLUMNS + 1)
        for j in range(ROWS + 1)
        if (i + j) % 2 == 0
    )
    words = (" ".join(map(str, values)) for values in (middle, quat))
    place = 'pos="{}" quat="{}"'.format(*words)
    return f"""
    <mujoco>
      <visual><headlight ambient=".5 .5 .5" diffuse=".4 .4 .4" specular="0 0 0"/></visual>
      <worldbody>
        <camera name="eye"/>
        <body {place}>
          <geom type="box" size=".35 .3 .001" pos="0 0 .0011" rgba="1 1 1 1"/>
          {squares}
        </body>
      </worldbody>
    </mujoco>"""


def opencv_camera(sensor: CameraSensor) -> tuple[np.ndarray, np.ndarray, float]:
    """Return K and d of CameraInfo as OpenCV has them, and the skew, which it does not know.

    The centre of OpenCV's first pixel is at 0.
    """
    info = info_message(sensor)
    k = np.reshape(info.k, (3, 3)).copy()
    skew, k[0, 1] = k[0, 1] / k[1, 1], 0.0
    k[:2, 2] -= 0.5
    return k, np.array(info.d), skew


def projected(
    sensor: CameraSensor, points: np.ndarray, turned=(0, 0, 0), at=(0, 0, 0)
) -> np.ndarray:
    """Return OpenCV's pixels of points (n, 3) that are turned and then moved."""
    k, d, skew = opencv_camera(sensor)
    pixels, _ = cv2.projectPoints(points, np.array(turned, float), np.array(at, float), k, d)
    pixels = pixels.reshape(-1, 2)
    pixels[:, 0] += skew * (pixels[:, 1] - k[1, 2])
    return pixels


@lenses
def test_detected_corners_are_where_camera_info_puts_them(see, lens):
    sensor = LENSES[lens]
    picture, _depth = see(board(), sensor)
    grey = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)
    flags = cv2.CALIB_CB_ACCURACY | cv2.CALIB_CB_EXHAUSTIVE
    found, corners = cv2.findChessboardCornersSB(grey, (COLUMNS, ROWS), flags=flags)
    assert found
    corners, expected = corners.reshape(-1, 2), projected(sensor, CORNERS, TURNED, MIDDLE)
    if np.linalg.norm(corners[0] - expected[0]) > np.linalg.norm(corners[-1] - expected[0]):
        corners = corners[::-1]
    errors = np.linalg.norm(corners - expected, axis=1)
    assert errors.mean() < 0.1
    assert errors.max() < 0.3


def points_of(sensor: CameraSensor, depth: np.ndarray) -> np.ndarray:
    points = np.empty((sensor.height, sensor.width, 4), np.float32)
    PointGrid(sensor).fill(points, depth, None)
    return points[..., :3]


SLOPE = """
<mujoco>
  <worldbody>
    <camera name="eye"/>
    <geom type="box" size="9 9 .1" pos="0 0 -1.5" euler="20 -25 0"/>
    <geom type="box" size=".1 .1 .1" pos="-.2 .1 -.7" euler="0 0 20"/>
  </worldbody>
</mujoco>"""


@lenses
def test_points_are_on_the_surface_and_on_the_rays_of_camera_info(see, lens):
    sensor = LENSES[lens]
    model = mujoco.MjModel.from_xml_string(SLOPE)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    _picture, depth = see(SLOPE, sensor)
    points = points_of(sensor, depth)
    distances, error = [], []
    for row, column in np.ndindex(12, 16):
        row, column = 20 + 40 * row, 20 + 40 * column
        point = points[row, column].astype(float)
        ray = UPWARDS @ point / point[2]
        along = mujoco.mj_ray(model, data, np.zeros(3), ray, None, 1, -1, np.array([-1], np.int32))
        distances.append(along)
        error.append(point[2] - along)
    # Beside an edge the depth is that of the nearest pixel.
    assert np.quantile(np.abs(error), 0.95) < 1e-4
    assert np.abs(error).max() < 5e-3
    assert min(distances) < 0.7 < 1.0 < max(distances)
    pixels = projected(sensor, points.reshape(-1, 3).astype(float)).reshape(480, 640, 2)
    columns, rows = np.meshgrid(np.arange(640), np.arange(480))
    np.testing.assert_allclose(pixels[..., 0], columns, atol=1e-3)
    np.testing.assert_allclose(pixels[..., 1], rows, atol=1e-3)


def test_no_point_is_between_two_surfaces(see):
    sensor = LENSES["barrel"]
    step = SLOPE.replace('euler="20 -25 0"', "")
    _picture, depth = see(step, sensor)
    on_the_box, behind = (depth > 0.599) & (depth < 0.801), np.abs(depth - 1.4) < 1e-3
    assert on_the_box.mean() > 0.02
    assert np.all(on_the_box | behind)


@lenses
def test_every_pixel_of_a_picture_shows_something(see, lens):
    picture, depth = see(SLOPE, LENSES[lens])
    assert np.isfinite(depth).all()
    assert picture.max(axis=2).min() > 0


def test_the_same_intrinsics_as_a_field_of_view_give_the_same_view(see):
    focal_length = WIDE.lens.fx
    written = replace(WIDE, intrinsics=(focal_length, focal_length, 320.0, 240.0, 0.0))
    plain, same = see(SLOPE, WIDE), see(SLOPE, written)
    assert np.array_equal(plain[0], same[0])
    assert np.array_equal(plain[1], same[1])
    points = points_of(WIDE, plain[1]), points_of(written, same[1])
    assert np.array_equal(*points, equal_nan=True)


def test_a_distortion_of_nothing_is_none(see):
    sensor = replace(WIDE, distortion=(1e-15, 0.0, 0.0, 0.0, 0.0))
    plain, same = see(board(), WIDE), see(board(), sensor)
    np.testing.assert_allclose(plain[1], same[1], atol=1e-5)
    assert np.abs(plain[0].astype(int) - same[0]).max() <= 1


@pytest.mark.parametrize("lens", ["pinhole", "cushion"])
def test_the_camera_of_the_model_has_the_same_projection(lens):
    sensor = LENSES[lens]
    spec = mujoco.MjSpec()
    add_cameras(spec, {"link": spec.worldbody.add_body(name="link")}, [sensor])
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    scene, camera = mujoco.MjvScene(model, maxgeom=10), mujoco.MjvCamera()
    camera.type, camera.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, 0
    category = mujoco.mjtCatBit.mjCAT_ALL
    mujoco.mjv_updateScene(model, data, mujoco.MjvOption(), None, camera, category, scene)
    eye = scene.camera[0]
    sides = np.array([eye.frustum_center, eye.frustum_width, eye.frustum_top, eye.frustum_bottom])
    fx, fy, cx, cy, _skew = sensor.intrinsics
    expected = [(320 - cx) / fx, 320 / fx, cy / fy, (cy - 480) / fy]
    assert sides / eye.frustum_near == pytest.approx(np.array(expected), abs=1e-6)


def test_a_view_is_as_wide_as_the_lens_needs():
    assert PinholeView.of(WIDE) == PinholeView(640, 480, *(WIDE.lens.fx,) * 2, 320, 240)
    cushion, barrel = (PinholeView.of(LENSES[lens]) for lens in ("cushion", "barrel"))
    assert cushion.width < 640
    assert barrel.width > 700
