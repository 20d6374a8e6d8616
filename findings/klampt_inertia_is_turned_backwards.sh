#!/usr/bin/env bash
# Klampt 0.10.1.post1: the rpy of a URDF's <inertial> turns the inertia the wrong way round.
#
# A good guess is that the tensor is R I R^T with the rotation R of the rpy, and a look at an rpy of one
# quarter turn confirms it. Klampt takes R^T I R. For quarter turns about one axis both are the same;
# for any other rotation the products of inertia have the wrong sign or size, so that the mass matrix
# and inverse dynamics are those of another body, while mass, centre and gravity torques are right.
# CAD programs export such rotations, with principal moments. MuJoCo 4.0.0 gives NumPy's tensor.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'klampt==0.10.1.post1' 'mujoco==4.0.0'

"$folder/venv/bin/python" -W ignore - "$folder/arm.urdf" <<'PYTHON' | grep 'Klampt\|changed'
import sys
from importlib.metadata import version

import klampt
import mujoco
import numpy as np

path = sys.argv[1]
LINK = """<robot name="arm"><link name="base"/><link name="link"><inertial>
  <origin xyz="0 0 0" rpy="{r} {p} {y}"/><mass value="1"/>
  <inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="link"/>
    <origin xyz="0 0 0"/><axis xyz="0.6 0.8 0"/>
    <limit lower="-1" upper="1" effort="10" velocity="1"/></joint></robot>"""
AXIS = np.array([0.6, 0.8, 0])


def turn(axis: int, angle: float) -> np.ndarray:
    """Return the matrix of a rotation about x (0), y (1) or z (2)."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[first, first] = matrix[second, second] = np.cos(angle)
    matrix[second, first], matrix[first, second] = np.sin(angle), -np.sin(angle)
    return matrix


def inertias(rpy: tuple[float, float, float]) -> tuple[float, float, float, float]:
    """Return the inertia about the joint: Klampt, MuJoCo, R I R^T and R^T I R, in kg m2."""
    with open(path, "w") as file:
        file.write(LINK.format(r=rpy[0], p=rpy[1], y=rpy[2]))
    world = klampt.WorldModel()
    world.loadRobot(path)
    robot = world.robot(0)
    index = robot.link("link").index
    simulated = mujoco.MjModel.from_xml_path(path)
    data = mujoco.MjData(simulated)
    mujoco.mj_forward(simulated, data)
    full = np.zeros((1, 1))
    mujoco.mj_fullM(simulated, data, full)
    matrix = turn(2, rpy[2]) @ turn(1, rpy[1]) @ turn(0, rpy[0])
    tensor = np.diag([0.02, 0.03, 0.04])
    right, wrong = matrix @ tensor @ matrix.T, matrix.T @ tensor @ matrix
    return robot.getMassMatrix()[index][index], full[0, 0], AXIS @ right @ AXIS, AXIS @ wrong @ AXIS


print("Klampt", version("klampt"), "MuJoCo", version("mujoco"))
found = {rpy: inertias(rpy) for rpy in ((0, 0, np.pi / 2), (0, 0, 0.6), (0.3, 0.4, 0.5))}
for rpy, (planned, simulated, right, wrong) in found.items():
    print(
        f"rpy {np.round(rpy, 2)}: Klampt {planned:.5f}, MuJoCo {simulated:.5f}, "
        f"R I R^T {right:.5f}, R^T I R {wrong:.5f} kg m2"
    )
if not all(np.isclose(one[0], one[3]) and np.isclose(one[1], one[2]) for one in found.values()):
    sys.exit("the behaviour has changed")
if [bool(np.isclose(one[2], one[3])) for one in found.values()] != [True, False, False]:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# Klampt 0.10.1.post1 MuJoCo 4.0.0
# rpy [0.   0.   1.57]: Klampt 0.02360, MuJoCo 0.02360, R I R^T 0.02360, R^T I R 0.02360 kg m2
# rpy [0.  0.  0.6]: Klampt 0.02998, MuJoCo 0.02103, R I R^T 0.02103, R^T I R 0.02998 kg m2
# rpy [0.3 0.4 0.5]: Klampt 0.02961, MuJoCo 0.02344, R I R^T 0.02344, R^T I R 0.02961 kg m2
