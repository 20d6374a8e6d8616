#!/usr/bin/env bash
# roboticstoolbox-python 1.5.0: rne() leaves out the offset of a fixed joint between two moving ones.
#
# A good guess is that a fixed joint in the middle of a chain is a rigid offset for the dynamics as it
# is for fkine(). Its link's own mass is at the right place, but what comes behind it is not: each
# moving joint is taken to sit at its own <origin> from the last moving joint, and the fixed joints
# between are skipped. The 1 kg here is held at a lever of 0.9 m; gravload() answers for 0.4 m, and
# inertia(), coriolis() and accel() follow. Adapters, flanges and sensors on fixed joints before a wrist
# or a gripper are common. Issue 636 of petercorke/robotics-toolbox-python, "silently wrong for URDF
# robots with fixed joints", is closed; the mend of 1.5.0 concerns their masses. The torque that is
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
INERTIAL = """<inertial><mass value="{mass}"/>
  <inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial>"""
MOVING = """<joint name="{child}_joint" type="revolute"><parent link="{parent}"/>
  <child link="{child}"/><origin xyz="{at} 0 0"/><axis xyz="0 1 0"/>
  <limit lower="-2" upper="2" effort="50" velocity="1"/></joint>"""
FIXED = """<link name="adapter"/><joint name="bolts" type="fixed"><parent link="upper"/>
  <child link="adapter"/><origin xyz="{at} 0 0"/></joint>"""
ARMS = {
    "one origin of 0.9 m": MOVING.format(parent="upper", child="lower", at=0.9),
    "0.5 m by a fixed joint, 0.4 m": FIXED.format(at=0.5)
    + MOVING.format(parent="adapter", child="lower", at=0.4),
}


def torques(joints: str) -> tuple[float, float, float]:
    """Return gravload and inertia of the first joint, and its torque from the energy."""
    with open(path, "w") as file:
        file.write(
            f"""<robot name="arm"><link name="base"/>
            <link name="upper">{INERTIAL.format(mass=1e-6)}</link>
            <link name="lower">{INERTIAL.format(mass=1)}</link>
            {MOVING.format(parent="base", child="upper", at=0)}{joints}</robot>"""
        )
    arm = roboticstoolbox.Robot.URDF(path)
    heights = [arm.fkine([q, 0.0], end="lower").t[2] for q in (1e-6, -1e-6)]
    slope = 9.81 * (heights[0] - heights[1]) / 2e-6
    return float(arm.gravload([0.0, 0.0])[0]), float(arm.inertia([0.0, 0.0])[0, 0]), slope


print("roboticstoolbox-python", version("roboticstoolbox-python"))
found = []
for name, joints in ARMS.items():
    load, inertia, slope = torques(joints)
    found += [load / slope, inertia]
    print(f"{name}: gravload {load:.3f} N m, from the energy {slope:.3f}; inertia {inertia:.3f} kg m2")
if not np.allclose(found, (1, 0.81, 4 / 9, 0.16), atol=1e-3):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# roboticstoolbox-python 1.5.0
# one origin of 0.9 m: gravload -8.829 N m, from the energy -8.829; inertia 0.810 kg m2
# 0.5 m by a fixed joint, 0.4 m: gravload -3.924 N m, from the energy -8.829; inertia 0.160 kg m2
