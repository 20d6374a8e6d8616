#!/usr/bin/env bash
# ikpy 4.2.1: where a link has several joints, the chain follows the one that stands first in the file.
#
# A good guess for Chain.from_urdf_file(path) is the longest chain, the one with the moving joints, or an
# error where a link has two children and nothing says which is meant. The first <joint> with the link
# as its parent is taken. A camera's frame at the base, if its joint is written before the shoulder's,
# is then the whole chain: inverse_kinematics() returns two zeros for any target, and nothing is said.
# With the joint of the camera at the end of the file the chain is the arm. URDF gives the order of its
# elements no meaning. With a gripper the chain ends in one finger in place of the tool's frame in the
# same way. base_elements=["base_link", "shoulder"], link and joint in turn, says which way to go.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'ikpy==4.2.1' 'numpy==2.4.6'

"$folder/venv/bin/python" -W ignore - "$folder/arm.urdf" <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
from ikpy.chain import Chain

path = sys.argv[1]
CAMERA = """<joint name="camera_mount" type="fixed"><parent link="base_link"/><child link="camera"/>
  <origin xyz="0 0 0.5"/></joint>"""
ARM = "".join(
    f"""<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>
  <origin xyz="{x} 0 0"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>"""
    for name, parent, child, x in (("shoulder", "base_link", "upper", 0), ("elbow", "upper", "lower", 0.3))
)
TIP = '<joint name="tip" type="fixed"><parent link="lower"/><child link="tool"/><origin xyz="0.3 0 0"/></joint>'
LINKS = "".join(f'<link name="{name}"/>' for name in ("base_link", "camera", "upper", "lower", "tool"))
TARGET = (0.3, 0.3, 0.0)


def reached(first: str, second: str, **how: list[str]) -> tuple[list[str], float]:
    """Return the names of the chain's links and how far from the target its solution is, in m."""
    with open(path, "w") as file:
        file.write(f'<robot name="arm">{LINKS}{first}{second}{TIP}</robot>')
    chain = Chain.from_urdf_file(path, **how)
    end = chain.forward_kinematics(chain.inverse_kinematics(TARGET))[:3, 3]
    return [link.name for link in chain.links], float(np.linalg.norm(end - TARGET))


print("ikpy", version("ikpy"))
found = {
    "camera first": reached(CAMERA, ARM),
    "arm first": reached(ARM, CAMERA),
    "camera first, base_elements": reached(CAMERA, ARM, base_elements=["base_link", "shoulder"]),
}
for name, (links, error) in found.items():
    print(f"{name}: chain of {links}, {error:.3f} m from the target")
whole = ["Base link", "shoulder", "elbow", "tip"]
if [links for links, _ in found.values()] != [["Base link", "camera_mount"], whole, whole]:
    sys.exit("the behaviour has changed")
if not found["camera first"][1] > 0.3 or max(found["arm first"][1], found["camera first, base_elements"][1]) > 1e-3:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# ikpy 4.2.1
# camera first: chain of ['Base link', 'camera_mount'], 0.656 m from the target
# arm first: chain of ['Base link', 'shoulder', 'elbow', 'tip'], 0.000 m from the target
# camera first, base_elements: chain of ['Base link', 'shoulder', 'elbow', 'tip'], 0.000 m from the target
