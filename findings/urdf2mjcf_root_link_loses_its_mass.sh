#!/usr/bin/env bash
# urdf2mjcf 0.2.39: the root link of a URDF comes out without its mass, and joints without friction and mimics.
#
# A good guess is that a converter keeps what both formats have: inertia, damping, dry friction, coupled
# joints. The body of the root link has no <inertial>, so a mobile base of 2 kg weighs nothing though
# it gets a free joint, while the links above it keep theirs. <dynamics damping friction> and <mimic>
# are dropped, without a word in the log: a finger that is to follow its leader hangs loose. MuJoCo's
# own reader of URDF keeps all three.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'urdf2mjcf==0.2.39' 'mujoco==4.0.0'
cd "$folder"

cat > gripper.urdf <<'URDF'
<robot name="gripper">
  <link name="base"><inertial><mass value="2"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="left"><inertial><mass value="0.1"/>
    <inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="right"><inertial><mass value="0.1"/>
    <inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="open" type="prismatic"><parent link="base"/><child link="left"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.04" effort="10" velocity="1"/><dynamics damping="0.5" friction="0.2"/></joint>
  <joint name="follow" type="prismatic"><parent link="base"/><child link="right"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.04" effort="10" velocity="1"/><mimic joint="open"/></joint>
</robot>
URDF

venv/bin/urdf2mjcf gripper.urdf --output gripper.mjcf > log.txt 2>&1
venv/bin/python - <<'PYTHON'
import sys
from importlib.metadata import version
from pathlib import Path

import mujoco

text = Path("gripper.mjcf").read_text()
lost = ("damping", "frictionloss", "<equality")
converted = [word in text for word in lost]
base = text.split('<body name="base"')[1].split("<body")[0]
read = mujoco.MjModel.from_xml_path("gripper.urdf")
print("urdf2mjcf", version("urdf2mjcf"))
print(f"base has <inertial>: {'<inertial' in base}; it is free: {'<freejoint' in base}")
print("in the conversion: " + ", ".join(f"{word} {found}" for word, found in zip(lost, converted)))
print(f"by MuJoCo: damping {read.dof_damping[0]}, friction {read.dof_frictionloss[0]}, couplings {read.neq}")
print(f"words of it in the log: {[word for word in ('mimic', 'damping', 'inertia') if word in Path('log.txt').read_text()]}")
if "<inertial" in base or "<freejoint" not in base or any(converted):
    sys.exit("the behaviour has changed")
if (read.dof_damping[0], read.dof_frictionloss[0], read.neq) != (0.5, 0.2, 1):
    sys.exit("MuJoCo's reading has changed")
PYTHON
# Output seen:
# urdf2mjcf 0.2.39
# base has <inertial>: False; it is free: True
# in the conversion: damping False, frictionloss False, <equality False
# by MuJoCo: damping 0.5, friction 0.2, couplings 1
# words of it in the log: []
