#!/usr/bin/env bash
# mujoco-core 4.0.0: two boxes that are apart, with a margin: no contact, or a wrong distance.
#
# A good guess is that a contact's dist within the margin is the distance of the two shapes, and that
# no contact means that they are at least the margin apart. It holds, within a micrometre, for a box
# and the mesh of its eight corners, and for spheres, capsules, cylinders and planes.
# For two boxes, whose contacts come from a function of their own, some distances are several
# millimetres too large, and of a hundred pairs within 50 mm one has no contact at all, although
# they are less than 10 mm apart. mj_geomDistance is right. Whether boxes are in each other
# (margin 0) is right, too. A clearance read from contacts, or a proof by it, needs the mesh.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q "mujoco-core==4.0.0" "numpy==2.4.6"

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import mujoco
import numpy as np

MARGIN = 0.05
CORNERS = " ".join(f"{x} {y} {z}" for x in (-0.04, 0.04) for y in (-0.06, 0.06) for z in (-0.09, 0.09))
SHAPES = {"box": 'type="box" size=".04 .06 .09"', "corners": 'type="mesh" mesh="corners"'}


def compare(first, second):
    """Return the pairs within the margin, the worst dist in mm, and the missed pairs' distances."""
    model = mujoco.MjModel.from_xml_string(f"""
    <mujoco>
      <option><flag multiccd="disable"/></option>
      <asset><mesh name="corners" vertex="{CORNERS}"/></asset>
      <worldbody>
        <geom {SHAPES[first]} margin="{MARGIN}"/>
        <body><freejoint/><geom {SHAPES[second]}/></body>
      </worldbody>
    </mujoco>""")
    data = mujoco.MjData(model)
    rng = np.random.default_rng(0)
    near, worst, missed = 0, 0.0, []
    for _ in range(6000):
        place, turn = rng.normal(size=3), rng.normal(size=4)
        data.qpos[:3] = place * rng.uniform(0.02, 0.2) / np.linalg.norm(place)
        data.qpos[3:] = turn / np.linalg.norm(turn)
        mujoco.mj_forward(model, data)
        true = mujoco.mj_geomDistance(model, data, 0, 1, 1.0, None)
        if not 0.0 < true < MARGIN:
            continue
        near += 1
        if data.ncon:
            worst = max(worst, data.contact.dist.min() - true)
        else:
            missed.append(true)
    return near, worst * 1e3, missed


print("mujoco-core", version("mujoco-core"))
boxes, meshes = compare("box", "box"), compare("box", "corners")
for name, (near, worst, missed) in (("two boxes", boxes), ("box and corners", meshes)):
    least = f", the nearest {min(missed) * 1e3:.1f} mm apart" if missed else ""
    print(f"{name}: of {near} pairs within 50 mm {len(missed)} without a contact{least}; dist at "
          f"most {worst:.4f} mm too large")
if not (boxes[1] > 1.0 and boxes[2] and meshes[1] < 1e-3 and not meshes[2]):
    sys.exit("the behaviour has changed")
PYTHON
