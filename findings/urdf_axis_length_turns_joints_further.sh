#!/usr/bin/env bash
# Klampt 0.10.1.post1, rerun-sdk 0.41.0: a URDF axis that is no unit vector turns its joint further.
#
# URDF's axis is a direction; a good guess is that readers normalise it, as MuJoCo 4.0.0 does here and
# urdfdom's users do. At 0.5 rad about "0 0 2" Klampt turns the link by 1 rad. Rerun returns a
# quaternion of length 1.09, which stands for 0.94 rad once it is normalised. Both move a sliding joint
# twice as far. Neither says anything, and an axis such as "0 1 1" is not rare.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'klampt==0.10.1.post1' 'rerun-sdk==0.41.0' 'mujoco==4.0.0'

"$folder/venv/bin/python" -W ignore - "$folder" <<'PYTHON' | grep ':$\|rad\|changed'
import math
import sys
from importlib.metadata import version

import mujoco
import rerun.urdf
from klampt import WorldModel

path = f"{sys.argv[1]}/arm.urdf"
ROBOT = """<robot name="turntable"><link name="base"/>
  <link name="plate"><inertial><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="turn" type="revolute"><origin xyz="0 0 0"/><parent link="base"/>
    <child link="plate"/><axis xyz="{axis}"/>
    <limit lower="-3" upper="3" effort="10" velocity="1"/></joint>
</robot>"""
ANGLE = 0.5


def of_klampt() -> float:
    world = WorldModel()
    robot = world.loadRobot(path)
    configuration = robot.getConfig()
    configuration[robot.link("plate").getIndex()] = ANGLE
    robot.setConfig(configuration)
    rotation, _ = robot.link("plate").getTransform()
    return math.atan2(rotation[1], rotation[0])


def of_rerun() -> tuple[float, float]:
    tree = rerun.urdf.UrdfTree.from_file_path(path)
    transform = tree.get_joint_by_name("turn").compute_transform(ANGLE)
    ((x, y, z, w),) = transform.quaternion.as_arrow_array().to_pylist()
    return math.hypot(x, y, z, w), 2 * math.atan2(z, w)


def of_mujoco() -> float:
    model = mujoco.MjModel.from_xml_path(path)
    data = mujoco.MjData(model)
    data.qpos[0] = ANGLE
    mujoco.mj_kinematics(model, data)
    w, _, _, z = data.xquat[1]
    return 2 * math.atan2(z, w)


seen = []
for axis in ("0 0 1", "0 0 2"):
    with open(path, "w") as file:
        file.write(ROBOT.format(axis=axis))
    length, angle = of_rerun()
    seen += [round(value, 2) for value in (of_mujoco(), of_klampt(), length, angle)]
    print(f"axis {axis}, {ANGLE} rad:", flush=True)
    for name, text in (
        ("mujoco", f"{of_mujoco():.2f} rad"),
        ("klampt", f"{of_klampt():.2f} rad"),
        ("rerun-sdk", f"a quaternion of length {length:.2f}, {angle:.2f} rad"),
    ):
        print(f"  {name} {version(name)}: {text}", flush=True)
if seen != [0.5, 0.5, 1.0, 0.5, 0.5, 1.0, 1.09, 0.94]:
    print("the behaviour has changed")
    sys.exit(1)
PYTHON
# Output seen:
# axis 0 0 1, 0.5 rad:
#   mujoco 4.0.0: 0.50 rad
#   klampt 0.10.1.post1: 0.50 rad
#   rerun-sdk 0.41.0: a quaternion of length 1.00, 0.50 rad
# axis 0 0 2, 0.5 rad:
#   mujoco 4.0.0: 0.50 rad
#   klampt 0.10.1.post1: 1.00 rad
#   rerun-sdk 0.41.0: a quaternion of length 1.09, 0.94 rad
