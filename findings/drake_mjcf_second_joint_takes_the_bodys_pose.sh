#!/usr/bin/env bash
# drake 1.51.1 (1.58.0, for Python 3.12, too): two joints in one MJCF body, the first of them at the wrong place.
#
# A good guess is that a body with two hinges, the usual way to write a universal joint or a pan and
# tilt head, moves as it does in MuJoCo: the body's pos and euler place it in its parent, and then the
# joints act in it, in their order. Drake gives the body's pose to the last joint. The first one turns
# about an axis and a point of the parent: at 0.4 rad the body here, which should turn on the spot, is
# carried 0.2 m away. A first joint at 0 hides it, as does a body without pos and euler. There is no
# warning, although the parser warns of much that it skips. MuJoCo 4.0.0 agrees with the matrices that
# are multiplied here.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'drake==1.51.1' 'mujoco==4.0.0'

"$folder/venv/bin/python" - "$folder/head.xml" <<'PYTHON'
import sys
from importlib.metadata import version

import mujoco
import numpy as np
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

path = sys.argv[1]
HEAD = """<mujoco model="head"><worldbody><body name="head" pos="0.5 0.2 0.1" euler="0 0 40">
  <joint name="first" axis="0 1 0"/><joint name="second" axis="1 0 0"/><geom size="0.1"/>
</body></worldbody></mujoco>"""


def turn(axis: int, angle: float) -> np.ndarray:
    """Return the transform of a rotation about x (0), y (1) or z (2)."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(4)
    matrix[first, first] = matrix[second, second] = np.cos(angle)
    matrix[second, first], matrix[first, second] = np.sin(angle), -np.sin(angle)
    return matrix


with open(path, "w") as file:
    file.write(HEAD)
plant = MultibodyPlant(0.0)
Parser(plant).AddModels(path)
plant.Finalize()
context = plant.CreateDefaultContext()
model = mujoco.MjModel.from_xml_path(path)
data = mujoco.MjData(model)
placed = turn(2, np.radians(40))
placed[:3, 3] = 0.5, 0.2, 0.1


def poses(first: float, second: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the pose of the head: Drake, MuJoCo, by the matrices, and with the body's pose between."""
    plant.GetJointByName("first").set_angle(context, first)
    plant.GetJointByName("second").set_angle(context, second)
    drake = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName("head")).GetAsMatrix4()
    data.qpos[:] = first, second
    mujoco.mj_forward(model, data)
    simulated = np.eye(4)
    simulated[:3, :3], simulated[:3, 3] = data.body("head").xmat.reshape(3, 3), data.body("head").xpos
    right = placed @ turn(1, first) @ turn(0, second)
    return drake, simulated, right, turn(1, first) @ placed @ turn(0, second)


print("drake", version("drake"), "MuJoCo", version("mujoco"))
right = []
for first, second in ((0.0, 0.0), (0.0, 0.7), (0.4, 0.0), (0.4, 0.7)):
    drake, simulated, true, between = poses(first, second)
    away = np.linalg.norm(drake[:3, 3] - true[:3, 3])
    print(f"{first} {second} rad: Drake at {drake[:3, 3].round(3)}, MuJoCo at {simulated[:3, 3].round(3)}")
    right += [np.allclose(simulated, true), np.allclose(drake, between), away < 0.1]
if right != [True, True, True] * 2 + [True, True, False] * 2:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# drake 1.51.1 MuJoCo 4.0.0
# 0.0 0.0 rad: Drake at [0.5 0.2 0.1], MuJoCo at [0.5 0.2 0.1]
# 0.0 0.7 rad: Drake at [0.5 0.2 0.1], MuJoCo at [0.5 0.2 0.1]
# 0.4 0.0 rad: Drake at [ 0.499  0.2   -0.103], MuJoCo at [0.5 0.2 0.1]
# 0.4 0.7 rad: Drake at [ 0.499  0.2   -0.103], MuJoCo at [0.5 0.2 0.1]
