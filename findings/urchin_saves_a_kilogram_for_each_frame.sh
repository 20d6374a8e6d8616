#!/usr/bin/env bash
# urchin 0.0.30: a URDF that is loaded and saved has a kilogram at each of its bare frames.
#
# A good guess is that a link without <inertial>, such as tool0 or a camera's frame, is written as it
# was read. It gets an <inertial> of 1 kg with moments of inertia of 1 kg m2, and nothing is said. An
# arm of 1 kg with two such frames weighs 3 kg for whoever reads the saved file, here MuJoCo 4.0.0.
# The links in memory have these masses, too.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'urchin==0.0.30' 'mujoco==4.0.0'

"$folder/venv/bin/python" -W ignore - "$folder" <<'PYTHON'
import sys
from importlib.metadata import version

import mujoco
import urchin

folder = sys.argv[1]
ARM = """<robot name="arm">
  <link name="base"/>
  <link name="arm"><inertial><origin xyz="0.2 0 0"/><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="tool0"/>
  <link name="camera"/>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="10" velocity="1"/></joint>
  <joint name="at_tool" type="fixed"><parent link="arm"/><child link="tool0"/>
    <origin xyz="0.4 0 0"/></joint>
  <joint name="at_camera" type="fixed"><parent link="arm"/><child link="camera"/>
    <origin xyz="0.4 0 0.1"/></joint>
</robot>"""


def mass(path: str) -> float:
    """Return the mass of all that moves, in kg."""
    return float(mujoco.MjModel.from_xml_path(path).body_subtreemass[1])


read, saved = f"{folder}/arm.urdf", f"{folder}/saved.urdf"
with open(read, "w") as file:
    file.write(ARM)
urchin.URDF.load(read).save(saved)
with open(saved) as file:
    inertials = file.read().count("<inertial>")
print("urchin", version("urchin"), "MuJoCo", version("mujoco"))
print(f"as read: {ARM.count('<inertial>')} <inertial>, {mass(read):g} kg")
print(f"as saved: {inertials} <inertial>, {mass(saved):g} kg")
if (inertials, mass(read), mass(saved)) != (4, 1.0, 3.0):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# urchin 0.0.30 MuJoCo 4.0.0
# as read: 1 <inertial>, 1 kg
# as saved: 4 <inertial>, 3 kg
