#!/usr/bin/env bash
# ahrs 0.4.0: the angles of a DCM, of a Quaternion and of q2euler() are three different things.
#
# DCM(rpy=...), Quaternion(rpy=...), DCM.to_rpy(), Quaternion.to_angles() and common.orientation.q2euler()
# are all described with roll, pitch and yaw. A good guess is that they are inverse to each other. The two
# of Quaternion are, and they are those of a URDF. DCM(rpy=...) takes "roll->pitch->yaw" and means yaw,
# pitch, roll, as one note in its examples says; its own to_rpy() takes angles from the transposed matrix,
# so that neither the angles nor their reverse come back. q2euler() gives those of the inverse rotation as
# well. A single angle about x shows the wrong sign, and DCM(rpy=[r, 0, 0]) turns about z.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'ahrs==0.4.0' 'numpy==2.4.6'

"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
from ahrs import DCM, Quaternion
from ahrs.common.orientation import q2euler

RPY = np.array([0.1, 0.5, 0.9])


def about(axis: int, angle: float) -> np.ndarray:
    """Return the matrix of a turn about x (0), y (1) or z (2)."""
    matrix, (one, other) = np.eye(3), [(axis + 1) % 3, (axis + 2) % 3]
    matrix[one, one] = matrix[other, other] = np.cos(angle)
    matrix[other, one], matrix[one, other] = np.sin(angle), -np.sin(angle)
    return matrix


def angles_of(matrix: np.ndarray) -> np.ndarray:
    """Return roll, pitch and yaw as a URDF means them."""
    pitch = -np.arcsin(matrix[2, 0])
    return np.array([np.arctan2(matrix[2, 1], matrix[2, 2]), pitch, np.arctan2(matrix[1, 0], matrix[0, 0])])


matrix = about(2, RPY[2]) @ about(1, RPY[1]) @ about(0, RPY[0])
real = np.sqrt(1 + np.trace(matrix)) / 2
apart = matrix - matrix.T
quaternion = np.array([real, *np.array([apart[2, 1], apart[0, 2], apart[1, 0]]) / (4 * real)])
inverse = angles_of(matrix.T)
found = {
    "Quaternion(rpy) is Rz(yaw) Ry(pitch) Rx(roll)": np.allclose(np.array(Quaternion(rpy=RPY)), quaternion),
    "DCM(rpy) is": np.allclose(DCM(rpy=RPY), matrix),
    "DCM(reversed rpy) is": np.allclose(DCM(rpy=RPY[::-1]), matrix),
}
angles = {
    "Quaternion(rpy).to_angles()": np.array(Quaternion(rpy=RPY).to_angles()),
    "DCM(rpy).to_rpy()": DCM(rpy=RPY).to_rpy(),
    "DCM(reversed rpy).to_rpy()": DCM(rpy=RPY[::-1]).to_rpy(),
    "q2euler() of the quaternion": q2euler(quaternion),
    "q2euler() of 0.3 rad about x": q2euler(np.array([np.cos(0.15), np.sin(0.15), 0.0, 0.0])),
    "those of the inverse rotation": inverse,
}
print("ahrs", version("ahrs"), "rpy", RPY)
for name, value in {**found, **{key: value.round(4) for key, value in angles.items()}}.items():
    print(f"{name}:", value)
right = [
    list(found.values()) == [True, False, True],
    np.allclose(angles["Quaternion(rpy).to_angles()"], RPY),
    np.allclose(angles["DCM(rpy).to_rpy()"], inverse[::-1]),
    np.allclose(angles["DCM(reversed rpy).to_rpy()"], inverse),
    np.allclose(angles["q2euler() of the quaternion"], inverse),
    np.allclose(angles["q2euler() of 0.3 rad about x"], [-0.3, 0, 0]),
]
if not all(right):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# ahrs 0.4.0 rpy [0.1 0.5 0.9]
# Quaternion(rpy) is Rz(yaw) Ry(pitch) Rx(roll): True
# DCM(rpy) is: False
# DCM(reversed rpy) is: True
# Quaternion(rpy).to_angles(): [0.1 0.5 0.9]
# DCM(rpy).to_rpy(): [-0.9417 -0.3841  0.3428]
# DCM(reversed rpy).to_rpy(): [ 0.3428 -0.3841 -0.9417]
# q2euler() of the quaternion: [ 0.3428 -0.3841 -0.9417]
# q2euler() of 0.3 rad about x: [-0.3 -0.   0. ]
# those of the inverse rotation: [ 0.3428 -0.3841 -0.9417]
