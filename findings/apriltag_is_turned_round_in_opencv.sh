#!/usr/bin/env bash
# opencv-python-headless 5.0.0.93, pupil-apriltags 1.0.4.post11: the same tag, half a turn and half a pixel apart.
#
# OpenCV's examples have the axis x of a tag to the right, y up and z out of it, AprilTag's library x to the
# right, y down and z into it. A good guess is that the two poses of a printed tag36h11 differ by that
# alone, half a turn about x. It is half a turn about y: OpenCV's DICT_APRILTAG_36h11 holds the
# codes turned by 180 degrees in the plane of the tag, so that its upper left corner is AprilTag's lower
# right one. A robot that was calibrated with one and runs with the other grasps from the far side.
# Corners differ by half a pixel, too: AprilTag counts from the picture's corner, OpenCV, whose
# calibration gives cx and cy, from the middle of the first pixel.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'opencv-python-headless==5.0.0.93' 'pupil-apriltags==1.0.4.post11' \
  'numpy==2.4.6'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import cv2
import numpy as np
from pupil_apriltags import Detector

CODES = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
FINE, FOCAL, SIDE = 8, 500.0, 0.16
CAMERA = np.array([[FOCAL, 0, 319.5], [0, FOCAL, 239.5], [0, 0, 1]])


def picture(angle: float, middle: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Return a picture of tag 5 and its corners, upper left first, clockwise, in OpenCV's coordinates."""
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * size / 2
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    corners = square @ turn.T + middle  # from the picture's corner, as lengths
    marker = cv2.aruco.generateImageMarker(CODES, 5, 800)
    large = np.full((480 * FINE, 640 * FINE), 255, np.uint8)
    edges = np.array([[0, 0], [800, 0], [800, 800], [0, 800]]) - 0.5
    into = cv2.getPerspectiveTransform(edges.astype(np.float32), (corners * FINE - 0.5).astype(np.float32))
    how = {"flags": cv2.INTER_NEAREST, "borderMode": cv2.BORDER_TRANSPARENT}
    cv2.warpPerspective(marker, into, (640 * FINE, 480 * FINE), large, **how)
    return cv2.resize(large, (640, 480), interpolation=cv2.INTER_AREA), corners - 0.5


parameters = cv2.aruco.DetectorParameters()
parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
opencv, apriltag = cv2.aruco.ArucoDetector(CODES, parameters), Detector(families="tag36h11", quad_decimate=1.0)
SQUARE = np.array([[-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]]) * SIDE / 2
between, offsets = [], {"OpenCV": [], "AprilTag": []}
for angle, size in ((0.0, 160.0), (0.2, 150.3), (-0.3, 171.7), (0.4, 120.1)):
    image, true = picture(angle, np.array([330.3, 236.6]), size)
    corners = opencv.detectMarkers(image)[0][0][0].astype(float)
    seen = apriltag.detect(image, True, (FOCAL, FOCAL, 319.5, 239.5), SIDE)[0]
    turn = cv2.solvePnP(SQUARE, corners, CAMERA, None, flags=cv2.SOLVEPNP_IPPE_SQUARE)[1]
    between.append(cv2.Rodrigues(turn)[0].T @ seen.pose_R)
    offsets["OpenCV"].append(corners - true)
    # AprilTag's corners begin at its lower left and go counter-clockwise.
    nearest = [np.linalg.norm(seen.corners - corner, axis=1).argmin() for corner in true]
    offsets["AprilTag"].append(seen.corners[nearest] - true)
means = {name: np.mean(offset, axis=(0, 1)) for name, offset in offsets.items()}
print("OpenCV", version("opencv-python-headless"), "pupil-apriltags", version("pupil-apriltags"))
print("AprilTag's axes in those of OpenCV:", np.round(np.mean(between, axis=0)).astype(int).tolist())
places = ("upper left", "upper right", "lower right", "lower left")
print(f"AprilTag's lower left corner is the {places[nearest.index(0)]} one of OpenCV")
for name, mean in means.items():
    print(f"{name}: corners off by {np.round(mean, 1)} pixels, counted from the middle of the first one")
if not np.allclose(between, np.diag([-1, 1, -1]), atol=0.05):
    sys.exit("the behaviour has changed")
if np.abs(means["OpenCV"]).max() > 0.1 or np.abs(means["AprilTag"] - 0.5).max() > 0.1:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# OpenCV 5.0.0.93 pupil-apriltags 1.0.4.post11
# AprilTag's axes in those of OpenCV: [[-1, 0, 0], [0, 1, 0], [0, 0, -1]]
# AprilTag's lower left corner is the upper right one of OpenCV
# OpenCV: corners off by [-0.  0.] pixels, counted from the middle of the first one
# AprilTag: corners off by [0.5 0.5] pixels, counted from the middle of the first one
