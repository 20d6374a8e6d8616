#!/usr/bin/env bash
# urchin 0.0.30: NumPy's print options decide which numbers stand in a URDF that is saved.
#
# A good guess is that save() writes all digits, as it does for masses, limits and origins, or always the
# same ones. Axes, mesh scales, box sizes and colours are written by NumPy's array printing: 8 digits at
# best, and as few as np.set_printoptions() says. After the usual np.set_printoptions(precision=2,
# suppress=True), somewhere in the program or in what it imports, a mesh scale of 0.001 is saved as 0, a
# box of 4 mm is flat, and an axis turns. Nothing is said. With np.printoptions(precision=17) around
# save() all digits are written.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'urchin==0.0.30' 'trimesh==5.2.0' 'numpy==2.4.6'

"$folder/venv/bin/python" -W ignore - "$folder" <<'PYTHON'
import os
import sys
from importlib.metadata import version
from xml.etree import ElementTree

import numpy as np
import trimesh
import urchin

folder = sys.argv[1]
AXIS = np.array([3.0, 1.0, 10.0]) / np.sqrt(110)
ARM = """<robot name="arm"><link name="base"><visual><geometry>
  <mesh filename="part.stl" scale="0.001 0.001 0.001"/></geometry></visual></link><link name="link">
  <visual><geometry><box size="0.0254 0.1 0.004"/></geometry></visual></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="link"/><axis xyz="{} {} {}"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>""".format(*AXIS)


def saved() -> dict[str, list[float]]:
    """Return the axis, the mesh's scale and the box's size of the robot once it is saved."""
    path = f"{folder}/saved/arm.urdf"
    urchin.URDF.load(f"{folder}/arm.urdf").save(path)
    root = ElementTree.parse(path).getroot()
    texts = {
        "axis": root.find("joint/axis").get("xyz"),
        "scale": root.find(".//mesh").get("scale"),
        "box": root.find(".//box").get("size"),
    }
    return {name: [float(number) for number in text.split()] for name, text in texts.items()}


os.mkdir(f"{folder}/saved")
trimesh.creation.box((100, 100, 100)).export(f"{folder}/part.stl")
with open(f"{folder}/arm.urdf", "w") as file:
    file.write(ARM)
print("urchin", version("urchin"), "NumPy", version("numpy"))
whole = saved()
np.set_printoptions(precision=2, suppress=True)
short = saved()
for name in whole:
    print(f"{name}: {whole[name]}, after set_printoptions(precision=2, suppress=True) {short[name]}")
apart = np.degrees(np.arccos(AXIS @ short["axis"] / np.linalg.norm(short["axis"])))
print(f"the axis has turned by {apart:.2f} degrees")
if not np.allclose(whole["axis"], AXIS) or (whole["scale"], whole["box"]) != ([0.001] * 3, [0.0254, 0.1, 0.004]):
    sys.exit("the behaviour has changed")
if short != {"axis": [0.29, 0.1, 0.95], "scale": [0.0] * 3, "box": [0.03, 0.1, 0.0]} or apart < 0.2:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# urchin 0.0.30 NumPy 2.4.6
# axis: [0.28603878, 0.09534626, 0.95346259], after set_printoptions(precision=2, suppress=True) [0.29, 0.1, 0.95]
# scale: [0.001, 0.001, 0.001], after set_printoptions(precision=2, suppress=True) [0.0, 0.0, 0.0]
# box: [0.0254, 0.1, 0.004], after set_printoptions(precision=2, suppress=True) [0.03, 0.1, 0.0]
# the axis has turned by 0.39 degrees
