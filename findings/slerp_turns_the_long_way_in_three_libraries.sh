#!/usr/bin/env bash
# spatialmath-python 1.1.18, pytransform3d 3.17.0, quaternionic 1.0.18: slerp may turn by 340 degrees in place of 20.
#
# q and -q are the same rotation, and which of them a sensor, a file or a product of quaternions gives is
# chance. A good guess is that an interpolation of rotations takes the short way in any case, as SciPy's
# Slerp, transformations and numpy-quaternion do. UnitQuaternion.interp() of spatialmath goes the long way
# unless shortest=True, while SO3.interp() and SE3.interp() of the same library go the short one. In
# pytransform3d quaternion_slerp() goes the long way unless shortest_path=True, while pq_slerp(), for
# poses, goes the short one. quaternionic.slerp() goes the long way. Half-way between 170 and -170
# degrees about z is then 0: a waypoint in which the tool looks backwards.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'spatialmath-python==1.1.18' 'pytransform3d==3.17.0' 'quaternionic==1.0.18' \
  'transformations==2026.1.18' 'numpy-quaternion==2024.0.13' 'scipy==1.16.3'

"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
import quaternion
import quaternionic
import transformations
from pytransform3d.rotations import quaternion_slerp
from pytransform3d.transformations import pq_slerp
from scipy.spatial.transform import Rotation, Slerp
from spatialmath import SE3, SO3, UnitQuaternion

TURNS = Rotation.from_euler("z", [170, -170], degrees=True)
first, second = np.roll(TURNS.as_quat(), 1, axis=1)
matrices = TURNS.as_matrix()


def degrees(scalar_first: np.ndarray) -> float:
    """Return the angle about z."""
    return float(np.degrees(Rotation.from_quat(np.roll(scalar_first, -1)).as_rotvec()[2]))


def turned(matrix: np.ndarray) -> float:
    """Return the angle about z."""
    return float(np.degrees(Rotation.from_matrix(matrix).as_rotvec()[2]))


still = np.zeros(3)
found = {
    "SciPy Slerp": turned(Slerp([0, 1], TURNS)(0.5).as_matrix()),
    "transformations.quaternion_slerp": degrees(transformations.quaternion_slerp(first, second, 0.5)),
    "numpy-quaternion slerp_evaluate": degrees(
        quaternion.as_float_array(quaternion.slerp_evaluate(*quaternion.from_float_array([first, second]), 0.5))
    ),
    "spatialmath SO3.interp": turned(SO3(matrices[0]).interp(SO3(matrices[1]), 0.5).R),
    "spatialmath SE3.interp": turned(SE3.Rt(matrices[0], still).interp(SE3.Rt(matrices[1], still), 0.5).R),
    "pytransform3d pq_slerp": degrees(pq_slerp(np.r_[still, first], np.r_[still, second], 0.5)[3:]),
    "pytransform3d quaternion_slerp": degrees(quaternion_slerp(first, second, 0.5)),
    "spatialmath UnitQuaternion.interp": degrees(UnitQuaternion(first).interp(UnitQuaternion(second), 0.5).A),
    "quaternionic.slerp": degrees(
        np.array(quaternionic.slerp(quaternionic.array(first), quaternionic.array(second), 0.5))
    ),
}
packages = ("spatialmath-python", "pytransform3d", "quaternionic")
print(*(f"{name} {version(name)}" for name in packages))
for name, angle in found.items():
    print(f"{name}: {abs(angle):.1f} degrees half-way between 170 and -170")
if [round(abs(angle)) for angle in found.values()] != [180] * 6 + [0] * 3:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# spatialmath-python 1.1.18 pytransform3d 3.17.0 quaternionic 1.0.18
# SciPy Slerp: 180.0 degrees half-way between 170 and -170
# transformations.quaternion_slerp: 180.0 degrees half-way between 170 and -170
# numpy-quaternion slerp_evaluate: 180.0 degrees half-way between 170 and -170
# spatialmath SO3.interp: 180.0 degrees half-way between 170 and -170
# spatialmath SE3.interp: 180.0 degrees half-way between 170 and -170
# pytransform3d pq_slerp: 180.0 degrees half-way between 170 and -170
# pytransform3d quaternion_slerp: 0.0 degrees half-way between 170 and -170
# spatialmath UnitQuaternion.interp: 0.0 degrees half-way between 170 and -170
# quaternionic.slerp: 0.0 degrees half-way between 170 and -170
