#!/usr/bin/env bash
# pyquaternion 0.9.9: integrate() takes body rates, and yaw_pitch_roll is in the order of x, y and z.
#
# Both say otherwise. integrate(rate, timestep) has "rotation rates about the global x, y and z axes": a
# good guess is that a gyroscope's rates, which are about the axes of the body, have to be rotated before.
# They must not: it is the body's axes that it turns about, and rates in the world's frame give another
# attitude from the first step on. yaw_pitch_roll is "intrinsic, following the z-y'-x'' convention", as
# in aviation and, turned round, in a URDF's rpy. It gives the angles of R_x(roll) R_y(pitch) R_z(yaw): in
# an attitude that is built of yaw 0.3, pitch 0.2, roll 0.1 rad it finds 0.29, 0.22 and 0.04. About one
# axis alone all of these agree, which hides it. SciPy and NumPy say what is right.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'pyquaternion==0.9.9' 'scipy==1.16.3' 'numpy==2.4.6'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
from pyquaternion import Quaternion
from scipy.spatial.transform import Rotation

RATE, STEP = np.array([0.3, -0.2, 0.5]), 0.1
START = Rotation.from_euler("ZYX", [0.3, 0.2, 0.1])


def quaternion(rotation: Rotation) -> Quaternion:
    """Return the rotation for pyquaternion, which has the scalar first."""
    return Quaternion(np.roll(rotation.as_quat(), 1))


def apart(turned: Quaternion, rotation: Rotation) -> float:
    """Return the angle between two rotations in degrees."""
    return float(np.degrees((Rotation.from_matrix(turned.rotation_matrix) * rotation.inv()).magnitude()))


turned = quaternion(START)
turned.integrate(RATE, STEP)
increment = Rotation.from_rotvec(RATE * STEP)
world, body = apart(turned, increment * START), apart(turned, START * increment)
angles = quaternion(START).yaw_pitch_roll
back = quaternion(Rotation.from_euler("XYZ", [0.1, 0.2, 0.3])).yaw_pitch_roll
print("pyquaternion", version("pyquaternion"), "SciPy", version("scipy"))
print(f"integrate: {world:.3f} degrees from rates about the world's axes, {body:.3f} from those of the body")
print(f"yaw, pitch, roll of Rz(0.3) Ry(0.2) Rx(0.1): {np.round(angles, 3)}, SciPy {START.as_euler('ZYX').round(3)}")
print(f"yaw, pitch, roll of Rx(0.1) Ry(0.2) Rz(0.3): {np.round(back, 3)}")
if world < 0.5 or body > 1e-6 or abs(angles[2] - 0.1) < 0.05 or not np.allclose(back, (0.3, 0.2, 0.1)):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# pyquaternion 0.9.9 SciPy 1.16.3
# integrate: 1.078 degrees from rates about the world's axes, 0.000 from those of the body
# yaw, pitch, roll of Rz(0.3) Ry(0.2) Rx(0.1): [0.286 0.22  0.038], SciPy [0.3 0.2 0.1]
# yaw, pitch, roll of Rx(0.1) Ry(0.2) Rz(0.3): [0.3 0.2 0.1]
