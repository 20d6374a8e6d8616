#!/usr/bin/env bash
# urdf2casadi 1.0.0, casadi 3.8.2, pin 4.1.0: the dynamics leave out the rpy of <inertial>.
#
# 1.0.0 is what pip installs beside a casadi of today (1.2.0 asks for exactly 3.5.5). A good guess is that functions
# called inertia matrix and inverse dynamics take the whole <inertial>: mass and centre are right, so that every
# gravity torque agrees. The moments of inertia are used as if rpy were 0 0 0. CAD exports give principal
# moments and turn the frame, so 0.1, 0.2 and 0.3 change places: a wrist accelerates with half or three times
# the torque that it needs. An axis of 0 0 2 is entered as it is: the joint's inertia and torque come out four
# times and twice as large, and its "rotation" stretches what is behind it by a tenth. Pinocchio turns the inertia
# and normalises the axis.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'urdf2casadi==1.0.0' 'casadi==3.8.2' 'pin==4.1.0' 'numpy==2.4.6'

"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
import pinocchio
from urdf2casadi.urdfparser import URDFparser

URDF = """<robot name="arm"><link name="base"/><link name="hand"><inertial>
    <origin xyz="0.1 0 0" rpy="{rpy}"/><mass value="2"/>
    <inertia ixx="0.1" iyy="0.2" izz="0.3" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="wrist" type="revolute"><parent link="base"/><child link="hand"/><origin xyz="0 0 0"/>
    <axis xyz="0 {axis} 0"/><limit lower="-1" upper="1" effort="9" velocity="1"/></joint></robot>"""
QUARTER = "1.5707963267948966"
CASES = {
    "rpy 0 0 0": ("0 0 0", 1),
    "rpy of a quarter about x": (f"{QUARTER} 0 0", 1),
    "rpy of a quarter about z": (f"0 0 {QUARTER}", 1),
    "rpy 0 0 0, axis 0 2 0": ("0 0 0", 2),
}


def by_pinocchio(urdf: str) -> list[float]:
    """Return the joint's inertia, its torque at rest and the scale of its rotation."""
    model = pinocchio.buildModelFromXML(urdf)
    data = model.createData()
    zero = np.zeros(1)
    inertia = pinocchio.crba(model, data, zero)[0, 0]
    torque = pinocchio.computeGeneralizedGravity(model, data, zero)[0]
    pinocchio.forwardKinematics(model, data, zero + 0.5)
    return [float(inertia), float(torque), float(np.linalg.det(data.oMi[1].rotation))]


def by_urdf2casadi(urdf: str) -> list[float]:
    """Return the same from urdf2casadi."""
    parser = URDFparser()
    parser.from_string(urdf)
    inertia = parser.get_inertia_matrix_crba("base", "hand")([0.0])
    torque = parser.get_gravity_rnea("base", "hand", [0, 0, -9.81])([0.0])
    pose = np.array(parser.get_forward_kinematics("base", "hand")["T_fk"]([0.5]))
    return [float(inertia), float(torque), float(np.linalg.det(pose[:3, :3]))]


print(*(f"{name} {version(name)}" for name in ("urdf2casadi", "casadi", "pin")))
found = []
for name, (rpy, axis) in CASES.items():
    urdf = URDF.format(rpy=rpy, axis=axis)
    for library, ask in (("pin", by_pinocchio), ("urdf2casadi", by_urdf2casadi)):
        found.append(ask(urdf))
        inertia, torque, volume = found[-1]
        print(f"{name}: {library} inertia {inertia:.3f}, torque at rest {torque:.3f}, determinant {volume:.3f}")
right, turned_x, turned_z = [0.22, -1.962, 1], [0.32, -1.962, 1], [0.12, -1.962, 1]
expected = [right, right, turned_x, right, turned_z, right, right, [0.88, -3.924, 2.310]]
if not np.allclose(found, expected, atol=1e-3):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# urdf2casadi 1.0.0 casadi 3.8.2 pin 4.1.0
# rpy 0 0 0: pin inertia 0.220, torque at rest -1.962, determinant 1.000
# rpy 0 0 0: urdf2casadi inertia 0.220, torque at rest -1.962, determinant 1.000
# rpy of a quarter about x: pin inertia 0.320, torque at rest -1.962, determinant 1.000
# rpy of a quarter about x: urdf2casadi inertia 0.220, torque at rest -1.962, determinant 1.000
# rpy of a quarter about z: pin inertia 0.120, torque at rest -1.962, determinant 1.000
# rpy of a quarter about z: urdf2casadi inertia 0.220, torque at rest -1.962, determinant 1.000
# rpy 0 0 0, axis 0 2 0: pin inertia 0.220, torque at rest -1.962, determinant 1.000
# rpy 0 0 0, axis 0 2 0: urdf2casadi inertia 0.880, torque at rest -3.924, determinant 2.310
