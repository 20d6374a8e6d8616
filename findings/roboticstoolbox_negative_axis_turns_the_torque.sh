#!/usr/bin/env bash
# roboticstoolbox-python 1.5.0: a URDF joint about a negative axis gets its torque with the wrong sign.
#
# A good guess, since forward kinematics and the Jacobian are right, is that the dynamics of the same
# robot follow. For <axis xyz="0 -1 0"/> fkine() turns the link about -y, but rne(), and with it
# gravload(), inertia() and accel(), take the joint for one about +y: gravity compensation pushes the
# arm down, and the terms of the mass matrix that couple the joint with others have the wrong sign.
# "0 0 -1" and a sliding joint along "-1 0 0" do the same. Nothing is said. The torque that is
# compared here is the slope of the potential energy, from the library's own fkine().
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'roboticstoolbox-python==1.5.0' 'spatialmath-python==1.1.18'

"$folder/venv/bin/python" -W ignore - "$folder" <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
import roboticstoolbox

path = f"{sys.argv[1]}/arm.urdf"
INERTIAL = """<inertial><origin xyz="0.5 0 0"/><mass value="1"/>
  <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>"""
JOINT = """<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>
  <origin xyz="{at} 0 0"/><axis xyz="{axis}"/>
  <limit lower="-2" upper="2" effort="50" velocity="1"/></joint>"""
Q = np.array([0.3, 0.2])


def robot(kind: str, axis: str) -> roboticstoolbox.Robot:
    """Return an arm of two links of 1 kg; its second joint is of this kind and axis."""
    first = JOINT.format(name="j1", kind="revolute", parent="base", child="upper", at=0, axis="0 1 0")
    second = JOINT.format(name="j2", kind=kind, parent="upper", child="lower", at=1, axis=axis)
    links = f'<link name="upper">{INERTIAL}</link><link name="lower">{INERTIAL}</link>'
    with open(path, "w") as file:
        file.write(f'<robot name="arm"><link name="base"/>{links}{first}{second}</robot>')
    return roboticstoolbox.Robot.URDF(path)


def energy(arm: roboticstoolbox.Robot, q: np.ndarray) -> float:
    """Return the potential energy of the two links, in J."""
    heights = (arm.fkine(q, end=name).A @ [0.5, 0, 0, 1] for name in ("upper", "lower"))
    return sum(9.81 * height[2] for height in heights)


def slopes(arm: roboticstoolbox.Robot) -> np.ndarray:
    """Return what holds the arm against gravity, from its energy, in N m or N."""
    steps = np.eye(2) * 1e-6
    return np.array([(energy(arm, Q + step) - energy(arm, Q - step)) / 2e-6 for step in steps])


print("roboticstoolbox-python", version("roboticstoolbox-python"))
found = []
for kind, axis in (("revolute", "0 1 0"), ("revolute", "0 -1 0"), ("prismatic", "0 0 -1")):
    arm = robot(kind, axis)
    load, right = arm.gravload(Q), slopes(arm)
    found.append(load[1] / right[1])
    print(f"{kind} {axis}: gravload {load.round(3)}, from the energy {right.round(3)}")
if not np.allclose(found, (1, -1, -1), atol=1e-6):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# roboticstoolbox-python 1.5.0
# revolute 0 1 0: gravload [-18.362  -4.305], from the energy [-18.362  -4.305]
# revolute 0 -1 0: gravload [-18.938  -4.88 ], from the energy [-18.938   4.88 ]
# prismatic 0 0 -1: gravload [-18.164   9.372], from the energy [-18.164  -9.372]
