#!/usr/bin/env bash
# yourdfpy 0.0.60, idyntree 15.1.0: a URDF that is loaded and written has lost its mimic joints, and more.
#
# A good guess is that what a reader understands it also writes: both know <mimic> (yourdfpy's kinematics
# move the follower), so that to load, change a link and save keeps a gripper. Neither writes it: the
# finger that follows becomes a joint of its own, which hangs loose in a simulator and counts as one more
# to be commanded. yourdfpy also leaves out <safety_controller>, <calibration>, and all that it has no
# class for: <transmission>, <gazebo> and <ros2_control>, so that ROS has nothing left to control. Limits,
# damping and friction are written by both. There is no warning.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'yourdfpy==0.0.60' 'idyntree==15.1.0' 'numpy==2.4.6'

"$folder/venv/bin/python" -W ignore - "$folder" <<'PYTHON'
import sys
from importlib.metadata import version
from xml.etree import ElementTree

import idyntree.bindings as idyntree
import numpy as np
import yourdfpy

folder = sys.argv[1]
LINK = """<link name="{}"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
JOINT = """<joint name="{}" type="prismatic"><parent link="base"/><child link="{}"/><axis xyz="0 1 0"/>
  <limit lower="0" upper="0.04" effort="10" velocity="1"/><dynamics damping="0.5" friction="0.2"/>{}</joint>"""
SAFETY = '<safety_controller k_velocity="10" soft_lower_limit="0" soft_upper_limit="0.03"/><calibration rising="0"/>'
GRIPPER = (
    '<robot name="gripper">'
    + "".join(LINK.format(name) for name in ("base", "left", "right"))
    + JOINT.format("open", "left", SAFETY)
    + JOINT.format("follow", "right", '<mimic joint="open" multiplier="-1"/>')
    + '<gazebo reference="left"><mu1>0.9</mu1></gazebo><ros2_control name="arm" type="system"/>'
    + '<transmission name="t"><type>transmission_interface/SimpleTransmission</type></transmission></robot>'
)
TAGS = ("limit", "dynamics", "mimic", "safety_controller", "calibration", "transmission", "gazebo", "ros2_control")


def tags(path: str) -> list[str]:
    """Return which of the elements a file has."""
    return [tag for tag in TAGS if ElementTree.parse(path).getroot().find(f".//{tag}") is not None]


with open(f"{folder}/gripper.urdf", "w") as file:
    file.write(GRIPPER)
robot = yourdfpy.URDF.load(f"{folder}/gripper.urdf")
robot.update_cfg({"open": 0.02})
follower = robot.get_transform("right", "base")[1, 3]
robot.write_xml_file(f"{folder}/yourdfpy.urdf")
loader = idyntree.ModelLoader()
loader.loadModelFromFile(f"{folder}/gripper.urdf")
exporter = idyntree.ModelExporter()
exporter.init(loader.model())
exporter.exportModelToFile(f"{folder}/idyntree.urdf")
print("yourdfpy", version("yourdfpy"), "idyntree", version("idyntree"))
print(f"yourdfpy, as read: {robot.num_actuated_joints} actuated joint, the follower at {follower:.3f} m")
again = yourdfpy.URDF.load(f"{folder}/yourdfpy.urdf")
print(f"yourdfpy, its own file: {again.num_actuated_joints} actuated joints")
found = {name: tags(f"{folder}/{name}.urdf") for name in ("gripper", "yourdfpy", "idyntree")}
for name, kept in found.items():
    print(f"{name}.urdf:", *kept)
if (robot.num_actuated_joints, again.num_actuated_joints) != (1, 2) or not np.isclose(follower, -0.02):
    sys.exit("the behaviour has changed")
if found != {"gripper": list(TAGS), "yourdfpy": ["limit", "dynamics"], "idyntree": ["limit", "dynamics"]}:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# yourdfpy 0.0.60 idyntree 15.1.0
# yourdfpy, as read: 1 actuated joint, the follower at -0.020 m
# yourdfpy, its own file: 2 actuated joints
# gripper.urdf: limit dynamics mimic safety_controller calibration transmission gazebo ros2_control
# yourdfpy.urdf: limit dynamics
# idyntree.urdf: limit dynamics
