#!/usr/bin/env bash
# pin 4.1.0 (Pinocchio): buildModelFromMJCF() reads eulerseq="XYZ" as "xyz".
#
# In MJCF small letters mean that the axes turn along, capitals that they stay: eulerseq="XYZ" is how
# a file writes rotations as a URDF's rpy. A good guess is that what reads "zyx" right reads capitals
# right, or refuses them. Pinocchio takes the letters and not their case. The order is then turned
# round: for 0.1 0.2 0.3 rad a tip 1 m away is 6 cm off, and the more angles a file has the farther;
# with only one angle that is not zero both are the same, which hides it. MuJoCo 4.0.0 agrees with the
# matrices that are multiplied here.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'pin==4.1.0' 'mujoco==4.0.0'

"$folder/venv/bin/python" - "$folder/tool.xml" <<'PYTHON'
import sys
from importlib.metadata import version

import mujoco
import numpy as np
import pinocchio

path = sys.argv[1]
TOOL = """<mujoco><compiler angle="radian" eulerseq="{order}"/><worldbody><body name="wrist">
  <joint axis="0 0 1"/><geom size="0.05"/>
  <body name="tool" euler="{angles}"><body name="tip" pos="0 0 1"/></body>
</body></worldbody></mujoco>"""
ANGLES = (0.1, 0.2, 0.3)


def turn(axis: int, angle: float) -> np.ndarray:
    """Return the matrix of a rotation about x (0), y (1) or z (2)."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[first, first] = matrix[second, second] = np.cos(angle)
    matrix[second, first], matrix[first, second] = np.sin(angle), -np.sin(angle)
    return matrix


def expected(order: str) -> np.ndarray:
    """Return the place of the tip, from the matrices alone."""
    matrix = np.eye(3)
    for letter, angle in zip(order, ANGLES, strict=True):
        one = turn("xyz".index(letter.lower()), angle)
        matrix = one @ matrix if letter.isupper() else matrix @ one
    return matrix[:, 2]


def tips(order: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the place of the tip in Pinocchio and in MuJoCo."""
    with open(path, "w") as file:
        file.write(TOOL.format(order=order, angles=" ".join(map(str, ANGLES))))
    built = pinocchio.buildModelFromMJCF(path)
    model = built if isinstance(built, pinocchio.Model) else built[0]
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, pinocchio.neutral(model))
    simulated = mujoco.MjModel.from_xml_path(path)
    state = mujoco.MjData(simulated)
    mujoco.mj_forward(simulated, state)
    return data.oMf[model.getFrameId("tip")].translation, state.body("tip").xpos


print("pin", version("pin"), "MuJoCo", version("mujoco"))
right = []
for order in ("xyz", "zyx", "XYZ", "ZYX"):
    pinned, simulated = tips(order)
    true, small = expected(order), expected(order.lower())
    off = np.linalg.norm(pinned - true) * 1000
    print(f"{order}: Pinocchio {pinned.round(3)}, MuJoCo {simulated.round(3)}, {off:.0f} mm apart")
    right += [np.allclose(simulated, true), np.allclose(pinned, small), off > 10]
if right != [True, True, False] * 2 + [True, True, True] * 2:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# pin 4.1.0 MuJoCo 4.0.0
# xyz: Pinocchio [ 0.199 -0.098  0.975], MuJoCo [ 0.199 -0.098  0.975], 0 mm apart
# zyx: Pinocchio [ 0.218 -0.275  0.936], MuJoCo [ 0.218 -0.275  0.936], 0 mm apart
# XYZ: Pinocchio [ 0.199 -0.098  0.975], MuJoCo [ 0.218 -0.037  0.975], 64 mm apart
# ZYX: Pinocchio [ 0.218 -0.275  0.936], MuJoCo [ 0.199 -0.29   0.936], 24 mm apart
