#!/usr/bin/env bash
# usd-core 26.11: a NumPy array of quaternions is taken with the real part last; Gf.Quatf() and files have it first.
#
# Gf.Quatf(w, x, y, z), its printed form and the text of a .usda file begin with the real part. A good
# guess is that an array of rows w, x, y, z, given to an attribute such as a PointInstancer's orientations
# or to Vt.QuatfArray.FromNumpy(), means the same, as rows of points and colours mean what they show. The
# memory of a Gf.Quatf has the real part last, and the array is taken for that: (1, 0, 0, 0), no rotation,
# becomes half a turn about x, and nothing is said, since each row has the length of 1 either way.
# np.array(quaternions) is rolled in the same way, so that a round trip in NumPy looks right. Rows of
# x, y, z, w are written as they are meant.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'usd-core==26.11' 'numpy==2.4.6'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
from pxr import Gf, Usd, UsdGeom, Vt

ROWS = np.array([[1, 0, 0, 0], [0.8, 0.6, 0, 0]], np.float32)
stage = Usd.Stage.CreateInMemory()
instances = UsdGeom.PointInstancer.Define(stage, "/screws").CreateOrientationsfAttr()
instances.Set(ROWS)
text = [line for line in stage.GetRootLayer().ExportToString().splitlines() if "orientationsf" in line][0].strip()
single = Gf.Quatf(*ROWS[1].tolist())
given = {
    "attribute": instances.Get(),
    "FromNumpy": Vt.QuatfArray.FromNumpy(ROWS),
    "FromNumpy of x, y, z, w": Vt.QuatfArray.FromNumpy(np.roll(ROWS, -1, axis=1)),
}
print("usd-core", version("usd-core"))
print("rows:", ROWS.round(1).tolist())
print(f"Gf.Quatf(*row): real part {single.real:.1f}, imaginary {tuple(np.round(single.imaginary, 1).tolist())}")
print("in the file:", text)
turns = {}
for name, quaternions in given.items():
    turns[name] = [round(Gf.Rotation(Gf.Quatd(one)).GetAngle(), 1) for one in quaternions]
    print(f"{name}: real parts {[round(one.real, 1) for one in quaternions]}, turns of {turns[name]} degrees")
print("np.array() of the attribute:", np.array(instances.Get()).round(1).tolist())
if turns != {"attribute": [180, 180], "FromNumpy": [180, 180], "FromNumpy of x, y, z, w": [0, 73.7]}:
    sys.exit("the behaviour has changed")
if not np.isclose(single.real, 0.8) or not np.allclose(np.array(instances.Get()), ROWS):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# usd-core 26.11
# rows: [[1.0, 0.0, 0.0, 0.0], [0.800000011920929, 0.6000000238418579, 0.0, 0.0]]
# Gf.Quatf(*row): real part 0.8, imaginary (0.6000000238418579, 0.0, 0.0)
# in the file: quatf[] orientationsf = [(0, 1, 0, 0), (0, 0.8, 0.6, 0)]
# attribute: real parts [0.0, 0.0], turns of [180.0, 180.0] degrees
# FromNumpy: real parts [0.0, 0.0], turns of [180.0, 180.0] degrees
# FromNumpy of x, y, z, w: real parts [1.0, 0.8], turns of [0.0, 73.7] degrees
# np.array() of the attribute: [[1.0, 0.0, 0.0, 0.0], [0.800000011920929, 0.6000000238418579, 0.0, 0.0]]
