#!/usr/bin/env bash
# kinpy 0.6.1, pytransform3d 3.17.0, placo 0.10.2, tesseract-robotics 0.5.1: a <mimic> joint follows nothing.
#
# The second finger of a gripper is a joint with <mimic>. A good guess is that forward kinematics of the file
# moves it with the first, as robot_state_publisher does, and compas_robots 1.0.1 and yourdfpy 0.0.60 here; or that
# a library which cannot do it says so. kinpy, placo and tesseract make it a joint of its own, one number more in
# each configuration, and in pytransform3d it stays at 0 until it is set by name. With the left finger at 3 cm
# the right one is at 0: collision checks pass a half closed hand, an inverse kinematics with the finger as its
# tip solves for a joint that no motor has, and a vector of joints is one longer than from the others.
# None of the four warns.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'kinpy==0.6.1' 'pytransform3d[all]==3.17.0' 'compas_robots==1.0.1' 'yourdfpy==0.0.60' \
  'tesseract-robotics==0.5.1' 'numpy==2.3.5' 'lxml==6.1.1'
"$folder/venv/bin/pip" install -q 'placo==0.10.2'

"$folder/venv/bin/python" -W ignore - "$folder" 2>"$folder/said" <<'PYTHON' || { tail -n 5 "$folder/said"; exit 1; }
import sys
from importlib.metadata import version

import kinpy
import numpy as np
import placo
import yourdfpy
from compas_robots import RobotModel
from pytransform3d.urdf import UrdfTransformManager
from tesseract_robotics.tesseract_common import GeneralResourceLocator
from tesseract_robotics.tesseract_environment import Environment

FINGER = """<joint name="{name}" type="prismatic"><parent link="palm"/><child link="{name}_finger"/>
  <axis xyz="0 {way} 0"/><limit lower="0" upper="0.04" effort="1" velocity="1"/>{mimic}</joint>"""
URDF = f"""<robot name="hand"><link name="palm"/><link name="left_finger"/><link name="right_finger"/>
  {FINGER.format(name="left", way=1, mimic="")}
  {FINGER.format(name="right", way=-1, mimic='<mimic joint="left" multiplier="1"/>')}</robot>"""
SRDF = '<robot name="hand"><group name="hand"><joint name="left"/><joint name="right"/></group></robot>'
PATH = f"{sys.argv[1]}/hand.urdf"
OPEN = 0.03


def by_kinpy() -> float:
    chain = kinpy.build_chain_from_urdf(URDF)
    values = {name: OPEN if name == "left" else 0.0 for name in chain.get_joint_parameter_names()}
    return chain.forward_kinematics(values)["right_finger"].pos[1]


def by_pytransform3d() -> float:
    manager = UrdfTransformManager()
    manager.load_urdf(URDF)
    manager.set_joint("left", OPEN)
    return manager.get_transform("right_finger", "palm")[1, 3]


def by_placo() -> float:
    robot = placo.RobotWrapper(PATH, placo.Flags.ignore_collisions)
    robot.set_joint("left", OPEN)
    robot.update_kinematics()
    return robot.get_T_world_frame("right_finger")[1, 3]


def by_tesseract() -> float:
    environment = Environment()
    environment.init(URDF, SRDF, GeneralResourceLocator())
    environment.setState(["left"], np.array([OPEN]))
    return environment.getState().link_transforms["right_finger"].matrix()[1, 3]


def by_compas() -> float:
    robot = RobotModel.from_urdf_string(URDF)
    values = robot.zero_configuration()
    values["left"] = OPEN
    return robot.forward_kinematics(values, link_name="right_finger").point.y


def by_yourdfpy() -> float:
    robot = yourdfpy.URDF.load(PATH)
    robot.update_cfg({"left": OPEN})
    return robot.get_transform("right_finger", "palm")[1, 3]


LIBRARIES = {
    "kinpy": by_kinpy,
    "pytransform3d": by_pytransform3d,
    "placo": by_placo,
    "tesseract-robotics": by_tesseract,
    "compas_robots": by_compas,
    "yourdfpy": by_yourdfpy,
}
with open(PATH, "w") as file:
    file.write(URDF)
found = []
for name, where in LIBRARIES.items():
    found.append(round(float(where()), 6))
    print(f"{name} {version(name)}: left finger at y = {OPEN}, right finger at {found[-1] + 0.0}")
if found != [0.0] * 4 + [-OPEN] * 2:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# kinpy 0.6.1: left finger at y = 0.03, right finger at 0.0
# pytransform3d 3.17.0: left finger at y = 0.03, right finger at 0.0
# placo 0.10.2: left finger at y = 0.03, right finger at 0.0
# tesseract-robotics 0.5.1: left finger at y = 0.03, right finger at 0.0
# compas_robots 1.0.1: left finger at y = 0.03, right finger at -0.03
# yourdfpy 0.0.60: left finger at y = 0.03, right finger at -0.03
