#!/usr/bin/env bash
# scikit-robot 0.4.7: the rotation of a link's <inertial> is not applied to its inertia.
#
# A good guess is that a moment of inertia is that of URDF: about the axes that the rpy of <inertial>
# names. Of <inertial>'s <origin> only xyz is read; the matrix is taken as if it stood in the link's
# axes. The masses from CAD programs often have such a rotation, as they state principal moments. The
# link here has 0.02 kg m2 about its joint, and inverse dynamics asks for the torque of 0.01 kg m2.
# The same body with its matrix rotated by hand, and MuJoCo 4.0.0 with either, have the right value.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'scikit-robot==0.4.7' 'mujoco==4.0.0'

"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import sys
from importlib.metadata import version

import mujoco
import numpy as np
from skrobot.models.urdf import RobotModelFromURDF

LINK = """<robot name="turntable"><link name="base"/>
  <link name="wheel"><inertial><origin xyz="0 0 0" rpy="{rpy}"/><mass value="1"/>
    <inertia ixx="{ixx}" iyy="{iyy}" izz="0.025" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="wheel"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="10" velocity="1"/></joint>
</robot>"""
ROTATED = LINK.format(rpy="0 0 1.5707963267948966", ixx=0.01, iyy=0.02)
BY_HAND = LINK.format(rpy="0 0 0", ixx=0.02, iyy=0.01)
STEP_S = 0.01


def torque(urdf: str) -> float:
    """Return scikit-robot's torque for 1 rad/s2 from rest, in N m."""
    robot = RobotModelFromURDF(urdf=urdf)
    at_rest = np.zeros(1)
    moved = np.array([STEP_S**2])
    (value,) = robot.torque_vector(
        calc_statics_p=False, dt=STEP_S, av_prev=at_rest, av=at_rest, av_next=moved
    )
    return float(value)


def inertia(urdf: str) -> float:
    """Return MuJoCo's moment of inertia about the joint, in kg m2."""
    model = mujoco.MjModel.from_xml_string(urdf)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    matrix = np.zeros((1, 1))
    mujoco.mj_fullM(model, data, matrix)
    return float(matrix[0, 0])


print("scikit-robot", version("scikit-robot"), "MuJoCo", version("mujoco"))
for name, urdf in (("rotated by rpy", ROTATED), ("rotated by hand", BY_HAND)):
    print(f"{name}: torque {torque(urdf):.4f} N m, MuJoCo {inertia(urdf):.4f} kg m2")
if round(torque(ROTATED), 4) != 0.01 or round(torque(BY_HAND), 4) != 0.02:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# scikit-robot 0.4.7 MuJoCo 4.0.0
# rotated by rpy: torque 0.0100 N m, MuJoCo 0.0200 kg m2
# rotated by hand: torque 0.0200 N m, MuJoCo 0.0200 kg m2
