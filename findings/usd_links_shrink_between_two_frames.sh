#!/usr/bin/env bash
# usd-core 26.11: between two recorded poses a link shrinks, or turns the long way, by how they were written.
#
# A pose over time can be written as a matrix (xformOp:transform), as rotateZ or as orient, a quaternion. A
# good guess is that a reader between two frames gets a rotation between the two, the short way, from each
# of them. Matrices are interpolated number by number: half-way between 0 and 90 degrees the link has 71 %
# of its length, and between 0 and 170 degrees 9 %. rotateZ from 170 to -170 degrees passes 0. Only orient
# is a rotation by the short way. A recording of a robot at a few frames a second, of which viewers and
# renderers show the times between, is hit at each fast joint. The frames themselves are right.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'usd-core==26.11' 'numpy==2.4.6'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
from pxr import Gf, Usd, UsdGeom

UP = Gf.Vec3d(0, 0, 1)


def matrix(link: UsdGeom.Xform) -> tuple:
    """Return what adds a matrix, and the value for an angle in degrees."""
    return link.AddTransformOp(), lambda degrees: Gf.Matrix4d().SetRotate(Gf.Rotation(UP, degrees))


def rotate_z(link: UsdGeom.Xform) -> tuple:
    """Return what adds an angle about z, and the value for an angle in degrees."""
    return link.AddRotateZOp(), float


def orient(link: UsdGeom.Xform) -> tuple:
    """Return what adds a quaternion, and the value for an angle in degrees."""
    return link.AddOrientOp(), lambda degrees: Gf.Quatf(Gf.Rotation(UP, degrees).GetQuat())


def half_way(kind: object, first: float, last: float) -> tuple[float, float]:
    """Return the length of a 1 m link half-way between two frames, and its angle in degrees."""
    stage = Usd.Stage.CreateInMemory()
    link = UsdGeom.Xform.Define(stage, "/link")
    op, value = kind(link)
    op.Set(value(first), 0)
    op.Set(value(last), 1)
    end = UsdGeom.XformCache(0.5).GetLocalToWorldTransform(link.GetPrim()).TransformDir(Gf.Vec3d(1, 0, 0))
    return round(float(np.hypot(end[0], end[1])), 3), abs(round(float(np.degrees(np.arctan2(end[1], end[0])))))


print("usd-core", version("usd-core"))
found = {}
for first, last in ((0, 90), (0, 170), (170, -170)):
    for kind in (matrix, rotate_z, orient):
        found[kind.__name__, first, last] = half_way(kind, first, last)
        length, angle = found[kind.__name__, first, last]
        print(f"{kind.__name__} from {first} to {last} degrees: half-way {length} m long at {angle} degrees")
right = {
    ("matrix", 0, 90): (0.707, 45),
    ("rotate_z", 0, 90): (1.0, 45),
    ("orient", 0, 90): (1.0, 45),
    ("matrix", 0, 170): (0.087, 85),
    ("rotate_z", 0, 170): (1.0, 85),
    ("orient", 0, 170): (1.0, 85),
    ("matrix", 170, -170): (0.985, 180),
    ("rotate_z", 170, -170): (1.0, 0),
    ("orient", 170, -170): (1.0, 180),
}
if found != right:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# usd-core 26.11
# matrix from 0 to 90 degrees: half-way 0.707 m long at 45 degrees
# rotate_z from 0 to 90 degrees: half-way 1.0 m long at 45 degrees
# orient from 0 to 90 degrees: half-way 1.0 m long at 45 degrees
# matrix from 0 to 170 degrees: half-way 0.087 m long at 85 degrees
# rotate_z from 0 to 170 degrees: half-way 1.0 m long at 85 degrees
# orient from 0 to 170 degrees: half-way 1.0 m long at 85 degrees
# matrix from 170 to -170 degrees: half-way 0.985 m long at 180 degrees
# rotate_z from 170 to -170 degrees: half-way 1.0 m long at 0 degrees
# orient from 170 to -170 degrees: half-way 1.0 m long at 180 degrees
