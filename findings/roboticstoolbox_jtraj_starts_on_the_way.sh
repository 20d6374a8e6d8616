#!/usr/bin/env bash
# roboticstoolbox-python 1.5.0: jtraj() over times that do not begin at 0 does not begin at q0.
#
# "t is a uniformly-spaced time vector". A good guess is that jtraj([0, 0], [1, 2], t) goes from the first
# to the second over t, whatever its first time: from 5 s to 7 s, say, for the second part of a motion.
# quintic(), trapezoidal() and mtraj(), beside it, do so. jtraj() takes t as the time since the start
# and its last time as the duration: from 5 to 7 s it begins at 0.86, and at the first step the robot
# is told to jump there, with speeds that pass any check, those of a slower motion; from -1 to 1 s it
# begins at -31. No error or warning comes. jtraj(q0, q1, t - t[0]) is right.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'roboticstoolbox-python==1.5.0' 'spatialmath-python==1.1.18' 'numpy==2.4.6'

"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
from roboticstoolbox import jtraj, mtraj, quintic

START, END = np.array([0.0, 0.0]), np.array([1.0, 2.0])
print("roboticstoolbox", version("roboticstoolbox-python"))
found = {}
for first, last in ((0.0, 2.0), (5.0, 7.0), (-1.0, 1.0)):
    times = np.linspace(first, last, 201)
    joint, many, one = jtraj(START, END, times), mtraj(quintic, START, END, times), quintic(0.0, 1.0, times)
    print(f"{first} to {last} s, from {START} to {END}:")
    print(f"   jtraj from {joint.q[0].round(3) + 0.0} to {joint.q[-1].round(3)}, at most {joint.qd.max():.3f} rad/s")
    print(f"   mtraj from {many.q[0].round(3) + 0.0} to {many.q[-1].round(3)}, quintic from {one.q[0] + 0.0:.3f}")
    found[first] = np.allclose(joint.q[0], START), np.allclose(many.q[0], START), bool(np.isclose(one.q[0], 0))
    if not np.allclose(joint.q[-1], END) or not np.allclose(many.q[-1], END):
        sys.exit("the behaviour has changed")
if found != {0.0: (True, True, True), 5.0: (False, True, True), -1.0: (False, True, True)}:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# roboticstoolbox 1.5.0
# 0.0 to 2.0 s, from [0. 0.] to [1. 2.]:
#    jtraj from [0. 0.] to [1. 2.], at most 1.875 rad/s
#    mtraj from [0. 0.] to [1. 2.], quintic from 0.000
# 5.0 to 7.0 s, from [0. 0.] to [1. 2.]:
#    jtraj from [0.855 1.711] to [1. 2.], at most 0.357 rad/s
#    mtraj from [0. 0.] to [1. 2.], quintic from 0.000
# -1.0 to 1.0 s, from [0. 0.] to [1. 2.]:
#    jtraj from [-31. -62.] to [1. 2.], at most 240.000 rad/s
#    mtraj from [0. 0.] to [1. 2.], quintic from 0.000
