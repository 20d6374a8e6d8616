#!/usr/bin/env bash
# robosuite 1.5.2: euler2mat() and mat2euler() are not each other's inverse.
#
# Both are documented with (r, p, y) angles, so a good guess is that what one makes the other takes apart,
# as in transforms3d or scipy. mat2euler() gives angles about fixed axes (rpy as in a URDF); euler2mat()
# turns about x, y and z of the moving body. One angle alone comes back; with three, 0.1 0.5 0.9 rad comes
# back as 0.46 0.22 0.98, 0.44 rad away. States or actions of a robot-learning data set that
# went through both are other orientations, and nothing is out of range. SciPy 1.16.3 tells which is which.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'robosuite==1.5.2' 'mujoco==3.3.0' 'scipy==1.16.3'

"$folder/venv/bin/python" -W ignore - 2> /dev/null <<'PYTHON' | grep 'rad\|robosuite [0-9]\|changed'
import sys
from importlib.metadata import version

import numpy as np
import robosuite.utils.transform_utils as transforms
from scipy.spatial.transform import Rotation

print("robosuite", version("robosuite"))
right = []
for angles in ((0.4, 0.0, 0.0), (0.0, 0.4, 0.0), (0.1, 0.5, 0.9)):
    matrix = transforms.euler2mat(np.array(angles))
    back = transforms.mat2euler(matrix)
    moving = Rotation.from_euler("XYZ", angles).as_matrix()
    fixed = Rotation.from_euler("xyz", angles).as_matrix()
    away = Rotation.from_matrix(moving.T @ fixed).magnitude()
    print(f"{angles} rad comes back as {back.round(3)} rad, {away:.3f} rad apart")
    right += [
        np.allclose(matrix, moving, atol=1e-6),
        np.allclose(transforms.mat2euler(fixed), angles, atol=1e-6),
        np.allclose(back, angles, atol=1e-6),
    ]
if right != [True, True, True] * 2 + [True, True, False]:
    print("the behaviour has changed")
    sys.exit(1)
PYTHON
# Output seen:
# robosuite 1.5.2
# (0.4, 0.0, 0.0) rad comes back as [ 0.4 -0.   0. ] rad, 0.000 rad apart
# (0.0, 0.4, 0.0) rad comes back as [0.  0.4 0. ] rad, 0.000 rad apart
# (0.1, 0.5, 0.9) rad comes back as [0.463 0.22  0.978] rad, 0.442 rad apart
