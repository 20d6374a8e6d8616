#!/usr/bin/env bash
# laspy 2.7.0: a new LAS file, or a new LasData, rounds all coordinates to centimetres.
#
# LAS stores a coordinate as an integer times a scale that the file says. A good guess is that the scale is
# chosen from the points, or that it is fine enough for a scanner (0.001 is usual), or that nothing is
# lost before write(). laspy's scale is 0.01 m unless one gives another, and las.xyz = points rounds at
# once: points of a robot's depth camera move by up to 5 mm on each axis, a part of 3 mm is flat, and
# nothing is said. las.header.scales = [1e-4] * 3 before the assignment is taken and changes nothing: the
# points have taken their scale from the header already. A LasHeader with that scale, given to LasData,
# brings them back within 0.05 mm.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'laspy==2.7.0' 'numpy==2.4.6'

"$folder/venv/bin/python" -W error - "$folder/part.las" <<'PYTHON'
import sys
from importlib.metadata import version

import laspy
import numpy as np

path = sys.argv[1]
POINTS = np.random.default_rng(0).uniform([0, 0, 0], [0.2, 0.2, 0.003], (1000, 3))


def error(early: float | None, late: float | None) -> tuple[float, float, int]:
    """Return the largest error in memory and in the file, in mm, and how many heights are left.

    `early` is a scale for the header before the points are made of it, `late` one for it after that.
    """
    header = laspy.LasHeader(point_format=2, version="1.4")
    if early:
        header.scales = [early] * 3
    las = laspy.LasData(header)
    if late:
        las.header.scales = [late] * 3
    las.xyz = POINTS
    las.write(path)
    read = np.asarray(laspy.read(path).xyz)
    errors = [float(np.abs(xyz - POINTS).max()) * 1000 for xyz in (np.asarray(las.xyz), read)]
    return errors[0], errors[1], len(np.unique(read[:, 2]))


print("laspy", version("laspy"))
found = {"as it comes": error(None, None), "scale given late": error(None, 1e-4), "given early": error(1e-4, None)}
for name, (memory, file, heights) in found.items():
    print(f"{name}: off by {memory:.3f} mm in memory, {file:.3f} mm in the file; {heights} heights")
coarse, late, fine = found.values()
if not all(4.9 < one[0] <= 5 and 4.9 < one[1] <= 5 and one[2] == 1 for one in (coarse, late)):
    sys.exit("the behaviour has changed")
if not (fine[0] <= 0.0501 and fine[1] <= 0.0501 and fine[2] == 31):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# laspy 2.7.0
# as it comes: off by 4.997 mm in memory, 4.997 mm in the file; 1 heights
# scale given late: off by 4.997 mm in memory, 4.997 mm in the file; 1 heights
# given early: off by 0.050 mm in memory, 0.050 mm in the file; 31 heights
