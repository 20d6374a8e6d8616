#!/usr/bin/env bash
# gtsam 4.3.0, ouster-sdk 1.0.1, pin 4.1.0, pytransform3d 3.17.0: half-way between two poses is not half-way.
#
# A good guess for the pose between two known ones is what tf2 gives: the position on the line between the two,
# the rotation by slerp. spatialmath's SE3.interp() and pytransform3d's pq_slerp() do that. Pose3.slerp() of
# gtsam (in spite of its name), interp_pose() of ouster-sdk, SE3.Interpolate() of Pinocchio, and in pytransform3d
# transform_sclerp() and the transforms of TemporalTransformManager, move along a screw. A sensor that went 1 m
# straight ahead and turned by 90 degrees stood 0.21 m beside that line, by 170 degrees 0.46 m. Which of
# the two it is also depends on the frame: move the origin of the moving body 1 m aside and the tool's path
# is another one on the line, the same on the screw. Where a scan's poses come from tf2 and its points are
# put right by the SDK, the two disagree in the middle and agree at the ends.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'gtsam==4.3.0' 'ouster-sdk==1.0.1' 'pin==4.1.0' 'pytransform3d==3.17.0' \
  'spatialmath-python==1.1.18' 'scipy==1.16.3' 'numpy==2.4.6'

"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import sys
from importlib.metadata import version

import gtsam
import numpy as np
import pinocchio
from ouster.sdk.core import interp_pose
from pytransform3d import transformations
from pytransform3d.transform_manager import NumpyTimeseriesTransform
from scipy.spatial.transform import Rotation
from spatialmath import SE3

START = np.eye(4)


def half_way(end: np.ndarray) -> dict[str, np.ndarray]:
    """Return where each library is in the middle between START and an end."""
    pair = np.stack([START, end])
    pqs = np.array([transformations.pq_from_transform(pose) for pose in pair])
    series = NumpyTimeseriesTransform(np.array([0.0, 1.0]), pqs)
    return {
        "spatialmath SE3.interp": SE3(START).interp(SE3(end), 0.5).t,
        "pytransform3d pq_slerp": transformations.pq_slerp(*pqs, 0.5)[:3],
        "pytransform3d transform_sclerp": transformations.transform_sclerp(START, end, 0.5)[:3, 3],
        "pytransform3d NumpyTimeseriesTransform": series.as_matrix(np.array([0.5]))[0][:3, 3],
        "gtsam Pose3.slerp": gtsam.Pose3(START).slerp(0.5, gtsam.Pose3(end)).translation(),
        "ouster-sdk interp_pose": interp_pose(np.array([0.5]), np.array([0.0, 1.0]), pair)[0][:3, 3],
        "pin SE3.Interpolate": pinocchio.SE3.Interpolate(
            pinocchio.SE3(START), pinocchio.SE3(end), 0.5
        ).translation,
    }


print(*(f"{name} {version(name)}" for name in ("gtsam", "ouster-sdk", "pin", "pytransform3d")))
found = []
for degrees in (90, 170):
    end = np.eye(4)
    end[:3, :3] = Rotation.from_euler("z", degrees, degrees=True).as_matrix()
    end[0, 3] = 1.0
    print(f"1 m along x and {degrees} degrees about z:")
    for name, place in half_way(end).items():
        found.append(float(np.hypot(place[1], place[2])))
        print(f"   {name}: {(np.round(place, 3) + 0.0).tolist()}")
beside = [0.5 * np.tan(np.radians(degrees) / 4) for degrees in (90, 170)]
if not np.allclose(found, [0, 0] + [beside[0]] * 5 + [0, 0] + [beside[1]] * 5, atol=1e-4):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# gtsam 4.3.0 ouster-sdk 1.0.1 pin 4.1.0 pytransform3d 3.17.0
# 1 m along x and 90 degrees about z:
#    spatialmath SE3.interp: [0.5, 0.0, 0.0]
#    pytransform3d pq_slerp: [0.5, 0.0, 0.0]
#    pytransform3d transform_sclerp: [0.5, -0.207, 0.0]
#    pytransform3d NumpyTimeseriesTransform: [0.5, -0.207, 0.0]
#    gtsam Pose3.slerp: [0.5, -0.207, 0.0]
#    ouster-sdk interp_pose: [0.5, -0.207, 0.0]
#    pin SE3.Interpolate: [0.5, -0.207, 0.0]
# 1 m along x and 170 degrees about z:
#    spatialmath SE3.interp: [0.5, 0.0, 0.0]
#    pytransform3d pq_slerp: [0.5, 0.0, 0.0]
#    pytransform3d transform_sclerp: [0.5, -0.458, 0.0]
#    pytransform3d NumpyTimeseriesTransform: [0.5, -0.458, 0.0]
#    gtsam Pose3.slerp: [0.5, -0.458, 0.0]
#    ouster-sdk interp_pose: [0.5, -0.458, 0.0]
#    pin SE3.Interpolate: [0.5, -0.458, 0.0]
