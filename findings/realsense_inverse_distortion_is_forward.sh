#!/usr/bin/env bash
# pyrealsense2 2.59.1: inverse_brown_conrady is brown_conrady, and modified_brown_conrady is not undone at all.
#
# By its description inverse_brown_conrady "undistorts image instead of distorting it": its coefficients lead
# from a pixel to the ray. A good guess is that rs2_deproject_pixel_to_point() puts the pixel into the polynomial,
# and that calling such coefficients forward ones, for OpenCV say, is the well known mistake. It searches
# for the ray whose distorted pixel this is, just as for brown_conrady, and OpenCV's undistortPoints() with the
# same numbers gives the same ray. Coefficients that were fitted as the name says put a point near the corner
# off by 1 % of its distance here. With modified_brown_conrady rs2_project_point_to_pixel() distorts, but
# rs2_deproject_pixel_to_point() gives the ray of a camera without a lens: a pixel that is deprojected and
# projected lands 4 pixels away.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'pyrealsense2==2.59.1.11053' 'libusb-package==1.0.30.0' \
  'opencv-python-headless==4.12.0.88' 'numpy==2.2.6'

"$folder/venv/bin/python" - <<'PYTHON'
import ctypes
import sys
from importlib.metadata import version

import cv2
import libusb_package
import numpy as np

# pyrealsense2 links to libusb, which not every machine has.
ctypes.CDLL(str(libusb_package.get_library_path()), mode=ctypes.RTLD_GLOBAL)
import pyrealsense2

LENS = [0.12, -0.25, 0.002, -0.001, 0.05]
PIXEL = [540.0, 410.0]
CAMERA = np.array([[600.0, 0, 320], [0, 600, 240], [0, 0, 1]])


def polynomial(x: float, y: float) -> np.ndarray:
    """Return Brown and Conrady's polynomial of a point of the plane at 1 m."""
    k1, k2, p1, p2, k3 = LENS
    r2 = x * x + y * y
    radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
    return np.array(
        [x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * radial + 2 * p2 * x * y + p1 * (r2 + 2 * y * y)]
    )


plain = np.array([(PIXEL[0] - 320) / 600, (PIXEL[1] - 240) / 600])
rays = {
    "without a lens": plain,
    "the polynomial of the pixel": polynomial(*plain),
    "OpenCV, undistortPoints": cv2.undistortPoints(np.array([[PIXEL]]), CAMERA, np.array(LENS)).ravel(),
}
print("pyrealsense2", version("pyrealsense2"), "opencv", cv2.__version__)
back = {}
for model in ("brown_conrady", "inverse_brown_conrady", "modified_brown_conrady"):
    camera = pyrealsense2.intrinsics()
    camera.width, camera.height, camera.ppx, camera.ppy, camera.fx, camera.fy = 640, 480, 320, 240, 600, 600
    camera.model, camera.coeffs = getattr(pyrealsense2.distortion, model), LENS
    point = pyrealsense2.rs2_deproject_pixel_to_point(camera, PIXEL, 1.0)
    rays[model] = np.array(point[:2])
    again = pyrealsense2.rs2_project_point_to_pixel(camera, point)
    back[model] = float(np.hypot(*np.subtract(again, PIXEL)))
for name, ray in rays.items():
    print(f"{name}: ray {ray.round(4).tolist()}" + (f", {back[name]:.2f} px off" if name in back else ""))
plain, inverse, forward, *models = rays.values()
if not (
    all(np.allclose(ray, forward, atol=1e-4) for ray in models[:2])
    and np.allclose(models[2], plain, atol=1e-5)
    and np.abs(inverse - forward).max() > 0.005
    and back["inverse_brown_conrady"] < 0.05
    and back["modified_brown_conrady"] > 1
):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# pyrealsense2 2.59.1.11053 opencv 4.12.0
# without a lens: ray [0.3667, 0.2833]
# the polynomial of the pixel: ray [0.372, 0.2881]
# OpenCV, undistortPoints: ray [0.3615, 0.2787]
# brown_conrady: ray [0.3615, 0.2787], 0.00 px off
# inverse_brown_conrady: ray [0.3615, 0.2787], 0.00 px off
# modified_brown_conrady: ray [0.3667, 0.2833], 4.28 px off
