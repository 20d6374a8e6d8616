#!/usr/bin/env bash
# roboticstoolbox-python 1.5.0: Robot.URDF makes a damper of a joint's dry friction, and drops its damping.
#
# <dynamics damping="0.5" friction="0.2"/> is 0.5 N m s/rad and 0.2 N m. A Link has a place for both, B for
# viscous friction and Tc for Coulomb's, and a good guess is that damping becomes B and friction Tc, or
# that both are left out. B is 0.2 and Tc is 0: at 2 rad/s rne() adds 0.4 N m, where damping and friction
# are 1.2, and near standstill 0, where 0.2 hold the joint. A joint with damping alone is free
# of any resistance. MuJoCo 4.0.0 reads damping and friction as they are.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'roboticstoolbox-python==1.5.0' 'spatialmath-python==1.1.18' 'mujoco==4.0.0'

"$folder/venv/bin/python" -W ignore - "$folder/turntable.urdf" <<'PYTHON'
import sys
from importlib.metadata import version

import mujoco
import numpy as np
from roboticstoolbox import Robot

path = sys.argv[1]
TURNTABLE = """<robot name="turntable"><link name="base"/><link name="disc"><inertial><mass value="1"/>
  <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="disc"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="10" velocity="3"/><dynamics damping="{}" friction="{}"/></joint></robot>"""
SPEED = 2.0

print("roboticstoolbox", version("roboticstoolbox-python"), "mujoco", version("mujoco"))
right = []
for damping, friction in ((0.5, 0.2), (0.5, 0.0), (0.0, 0.2)):
    with open(path, "w") as file:
        file.write(TURNTABLE.format(damping, friction))
    robot, model = Robot.URDF(path), mujoco.MjModel.from_xml_path(path)
    link = robot.link_dict["disc"]
    torque = float(robot.rne(np.zeros(1), np.array([SPEED]), np.zeros(1))[0])
    print(f"damping {damping}, friction {friction}: B {link.B}, Tc {link.Tc}, {torque:.2f} N m at {SPEED} rad/s")
    print(f"   MuJoCo: damping {model.dof_damping[0]}, friction {model.dof_frictionloss[0]}")
    right += [link.B == friction, not link.Tc.any(), np.isclose(torque, friction * SPEED)]
    right += [np.allclose((model.dof_damping[0], model.dof_frictionloss[0]), (damping, friction))]
if not all(right):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# roboticstoolbox 1.5.0 mujoco 4.0.0
# damping 0.5, friction 0.2: B 0.2, Tc [0. 0.], 0.40 N m at 2.0 rad/s
#    MuJoCo: damping 0.5, friction 0.2
# damping 0.5, friction 0.0: B 0.0, Tc [0. 0.], 0.00 N m at 2.0 rad/s
#    MuJoCo: damping 0.5, friction 0.0
# damping 0.0, friction 0.2: B 0.2, Tc [0. 0.], 0.40 N m at 2.0 rad/s
#    MuJoCo: damping 0.0, friction 0.2
