#!/usr/bin/env bash
# pin 4.1.0 (Pinocchio): the total mass and the centre of mass of an arm leave out its base.
#
# computeTotalMass() returns "the total mass of the model", and a good guess is the sum of the masses of
# the URDF, as iDynTree and Drake give it. The root link of a model that is built without a root joint
# belongs to the universe, and the universe is not counted: an arm of 2.5 kg on a base of 8 kg weighs
# 2.5 kg, and centerOfMass() is that of the arm alone, out over the ground on which the base would hold it.
# Links that are fixed to the root, such as a pedestal, are left out as well. The mass is not lost: it is
# in model.inertias[0]. With a JointModelFreeFlyer the base counts. A check of payload, or whether a
# pedestal tips over, is wrong without a word.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'pin==4.1.0' 'mujoco==4.0.0' 'numpy==2.4.6'

"$folder/venv/bin/python" - "$folder/arm.urdf" <<'PYTHON'
import sys
from importlib.metadata import version

import mujoco
import numpy as np
import pinocchio

path = sys.argv[1]
LINK = """<link name="{}"><inertial><origin xyz="{} 0 0"/><mass value="{}"/>
  <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
ARM = (
    '<robot name="arm">'
    + LINK.format("base", 0, 6)
    + LINK.format("pedestal", 0, 2)
    + LINK.format("arm", 0.6, 2.5)
    + '<joint name="mount" type="fixed"><parent link="base"/><child link="pedestal"/></joint>'
    + '<joint name="turn" type="revolute"><parent link="pedestal"/><child link="arm"/><axis xyz="0 0 1"/>'
    + '<limit lower="-1" upper="1" effort="10" velocity="1"/></joint></robot>'
)


def weighed(*root: object) -> tuple[float, float, float]:
    """Return the mass, how far out its centre is, and the mass of the universe."""
    model = pinocchio.buildModelFromUrdf(path, *root)
    middle = pinocchio.centerOfMass(model, model.createData(), pinocchio.neutral(model))
    return pinocchio.computeTotalMass(model), float(middle[0]), model.inertias[0].mass


with open(path, "w") as file:
    file.write(ARM)
spec = mujoco.MjSpec.from_file(path)
spec.compiler.fusestatic = False
simulated = spec.compile()
data = mujoco.MjData(simulated)
mujoco.mj_forward(simulated, data)
mass = float(simulated.body_mass.sum())
middle = float(simulated.body_mass @ data.xipos[:, 0] / mass)
fixed, free = weighed(), weighed(pinocchio.JointModelFreeFlyer())
print("pin", version("pin"), "mujoco", version("mujoco"))
print(f"Pinocchio: {fixed[0]:.1f} kg, centre {fixed[1]:.3f} m out; the universe has {fixed[2]:.1f} kg")
print(f"Pinocchio with a free flyer: {free[0]:.1f} kg, centre {free[1]:.3f} m out; the universe has {free[2]:.1f} kg")
print(f"sum of the file, by MuJoCo's bodies: {mass:.1f} kg, centre {middle:.3f} m out")
if not np.allclose(fixed, (2.5, 0.6, 8)) or not np.allclose(free, (10.5, 1.5 / 10.5, 0)):
    sys.exit("the behaviour has changed")
if not np.allclose((mass, middle), (10.5, 1.5 / 10.5)):
    sys.exit("MuJoCo's reading has changed")
PYTHON
# Output seen:
# pin 4.1.0 mujoco 4.0.0
# Pinocchio: 2.5 kg, centre 0.600 m out; the universe has 8.0 kg
# Pinocchio with a free flyer: 10.5 kg, centre 0.143 m out; the universe has 0.0 kg
# sum of the file, by MuJoCo's bodies: 10.5 kg, centre 0.143 m out
