#!/usr/bin/env bash
# idyntree 15.1.0 (iDynTree): a continuous joint that states its effort and velocity has the limits 0 and 0.
#
# A good guess is that a continuous joint has no limits of position: URDF's lower and upper have no
# meaning for it, and its <limit> is there for effort and velocity. iDynTree takes the defaults of the
# absent lower and upper, so hasPosLimits() is true and the joint may only be at 0. Of the same joint
# without <limit> it says that it has none. What respects the model's limits, such as an optimiser,
# holds every wheel and wrist of this kind still; urdfdom, MuJoCo and Pinocchio let it turn.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'idyntree==15.1.0'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import idyntree.bindings as idyntree

ROBOT = """<robot name="turntable">
  <link name="base"/>
  <link name="plate"><inertial><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="turn" type="continuous"><parent link="base"/><child link="plate"/>
    <axis xyz="0 0 1"/>{limit}</joint>
</robot>"""


def limits(limit: str) -> tuple[bool, float, float]:
    """Return whether the joint has limits of position, and these, in rad."""
    loader = idyntree.ModelLoader()
    assert loader.loadModelFromString(ROBOT.format(limit=limit))
    model = loader.model()
    joint = model.getJoint(model.getJointIndex("turn"))
    return joint.hasPosLimits(), joint.getMinPosLimit(0), joint.getMaxPosLimit(0)


stated, absent = limits('<limit effort="10" velocity="2"/>'), limits("")
print("idyntree", version("idyntree"))
print("with <limit effort velocity>:", stated)
print("without <limit>:", absent)
if stated != (True, 0.0, 0.0) or absent[0]:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# idyntree 15.1.0
# with <limit effort velocity>: (True, 0.0, 0.0)
# without <limit>: (False, -1.7976931348623157e+308, 1.7976931348623157e+308)
