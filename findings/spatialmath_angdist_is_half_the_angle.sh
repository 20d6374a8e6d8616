#!/usr/bin/env bash
# spatialmath-python 1.1.18, pyquaternion 0.9.9: the angle between two quaternions is half of the rotation's.
#
# UnitQuaternion.angdist() returns an "angle in radians", which "we can consider as the angle between two
# quaternions", and a good guess is that of the rotation from one to the other, as SO3.angdist() of the
# same library gives it, and pytransform3d's quaternion_dist(). A quarter turn is 0.785 rad: the standard
# metric, 3, halves it, as do 1 and 2; of UnitQuaternion's five only metric 4 is the angle. SO3.angdist(),
# whose standard is 6, agrees with that, but not its own metric 3. pyquaternion's distance() and
# sym_distance(), geodesic ones, halve it too. A tolerance of an orientation that is checked in one class
# is twice as wide in the other.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'spatialmath-python==1.1.18' 'pyquaternion==0.9.9' \
  'pytransform3d==3.17.0' 'scipy==1.16.3'

"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
from pyquaternion import Quaternion
from pytransform3d.rotations import quaternion_dist
from scipy.spatial.transform import Rotation
from spatialmath import SO3, UnitQuaternion

START = Rotation.from_euler("xyz", [10, 20, 30], degrees=True)
END = Rotation.from_euler("xyz", [100, 0, -20], degrees=True)
first, second = (np.roll(rotation.as_quat(), 1) for rotation in (START, END))
true = (END * START.inv()).magnitude()
found = {
    "SciPy": true,
    "pytransform3d quaternion_dist": quaternion_dist(first, second),
    "spatialmath SO3.angdist": SO3(START.as_matrix()).angdist(SO3(END.as_matrix())),
    "spatialmath SO3.angdist, metric 3": SO3(START.as_matrix()).angdist(SO3(END.as_matrix()), metric=3),
    "spatialmath UnitQuaternion.angdist": UnitQuaternion(first).angdist(UnitQuaternion(second)),
    "spatialmath UnitQuaternion.angdist, metric 4": UnitQuaternion(first).angdist(UnitQuaternion(second), metric=4),
    "pyquaternion distance": Quaternion.distance(Quaternion(first), Quaternion(second)),
    "pyquaternion sym_distance": Quaternion.sym_distance(Quaternion(first), Quaternion(second)),
}
print("spatialmath", version("spatialmath-python"), "pyquaternion", version("pyquaternion"))
for name, angle in found.items():
    print(f"{name}: {np.degrees(angle):.2f} degrees, {angle / true:.3f} of the rotation")
if [round(float(angle / true), 3) for angle in found.values()] != [1, 1, 1, 0.5, 0.5, 1, 0.5, 0.5]:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# spatialmath 1.1.18 pyquaternion 0.9.9
# SciPy: 109.21 degrees, 1.000 of the rotation
# pytransform3d quaternion_dist: 109.21 degrees, 1.000 of the rotation
# spatialmath SO3.angdist: 109.21 degrees, 1.000 of the rotation
# spatialmath SO3.angdist, metric 3: 54.60 degrees, 0.500 of the rotation
# spatialmath UnitQuaternion.angdist: 54.60 degrees, 0.500 of the rotation
# spatialmath UnitQuaternion.angdist, metric 4: 109.21 degrees, 1.000 of the rotation
# pyquaternion distance: 54.60 degrees, 0.500 of the rotation
# pyquaternion sym_distance: 54.60 degrees, 0.500 of the rotation
