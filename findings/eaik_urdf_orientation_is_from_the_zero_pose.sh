#!/usr/bin/env bash
# eaik 1.2.2: analytic inverse kinematics of a URDF arm reaches another orientation than the one it is given.
#
# A good guess is that UrdfRobot(path).IK(pose) is for a pose of the URDF's last link, or of its tool. It
# is for a frame in the last joint that is parallel to the base when all joints are 0: the rotations of
# the <origin>s and what comes behind the last joint are left out, which IK() and fwdKin() agree on, so
# that a check of one by the other passes. The arm here has its last link upside down at 0, as many
# have: each of the eight answers, all of them said to be exact (is_LS is False), has the right place
# and points 180 degrees away. With the rotation of the last link at 0 taken out of the goal,
# goal[:3, :3] @ at_zero[:3, :3].T, all eight are right. A flange that is parallel to the base at 0
# hides it. The poses are checked by products of NumPy matrices.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'eaik==1.2.2'

"$folder/venv/bin/python" -W ignore - "$folder/arm.urdf" <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
from eaik.IK_URDF import UrdfRobot

path = sys.argv[1]
# The place of each joint in the one before it, and its turn about x.
JOINTS = (
    ((0, 0, 0.4), 0),
    ((0.1, 0, 0), -np.pi / 2),
    ((0.5, 0, 0), 0),
    ((0, 0.4, 0), -np.pi / 2),
    ((0, 0, 0), np.pi / 2),
    ((0, 0, 0), -np.pi / 2),
)
JOINT = """<link name="link{i}"/><joint name="joint{i}" type="revolute"><parent link="{parent}"/>
  <child link="link{i}"/><origin xyz="{x} {y} {z}" rpy="{roll} 0 0"/><axis xyz="0 0 1"/>
  <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>"""


def turn(axis: int, angle: float) -> np.ndarray:
    """Return the transform of a rotation about x (0) or z (2)."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(4)
    matrix[first, first] = matrix[second, second] = np.cos(angle)
    matrix[second, first], matrix[first, second] = np.sin(angle), -np.sin(angle)
    return matrix


def pose(q: np.ndarray) -> np.ndarray:
    """Return the pose of the last link."""
    reached = np.eye(4)
    for (place, roll), angle in zip(JOINTS, q, strict=True):
        origin = turn(0, roll)
        origin[:3, 3] = place
        reached = reached @ origin @ turn(2, angle)
    return reached


def errors(goal: np.ndarray, asked: np.ndarray) -> list[tuple[float, float]]:
    """Return how far each answer to `asked` is from the goal, in mm and degrees."""
    answer = arm.IK(asked)
    assert not any(answer.is_LS)
    found = []
    for q in answer.Q:
        reached = pose(q)
        cosine = (np.trace(reached[:3, :3].T @ goal[:3, :3]) - 1) / 2
        away = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
        found.append((1000 * np.linalg.norm(reached[:3, 3] - goal[:3, 3]), away))
    return found


parents = ["base", *(f"link{i}" for i in range(5))]
joints = (
    JOINT.format(i=i, parent=parent, x=place[0], y=place[1], z=place[2], roll=roll)
    for i, ((place, roll), parent) in enumerate(zip(JOINTS, parents, strict=True))
)
with open(path, "w") as file:
    file.write(f'<robot name="arm"><link name="base"/>{"".join(joints)}</robot>')
arm = UrdfRobot(path)
goal = pose(np.array([0.3, -0.4, 0.5, 0.6, 0.7, 0.8]))
mended = goal.copy()
mended[:3, :3] = goal[:3, :3] @ pose(np.zeros(6))[:3, :3].T
plain, right = errors(goal, goal), errors(goal, mended)
print("eaik", version("eaik"), arm.getKinematicFamily())
for name, found in (("the goal itself", plain), ("the goal without the turn at 0", right)):
    worst = np.max(found, axis=0)
    print(f"{name}: {len(found)} answers, at most {worst[0]:.4f} mm and {worst[1]:.4f} degrees off")
if len(plain) != 8 or not np.allclose(plain, [(0, 180)] * 8, atol=1e-3):
    sys.exit("the behaviour has changed")
if not np.allclose(right, 0, atol=1e-3):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# eaik 1.2.2 6R-SPHERICAL_SECOND_TWO_PARALLEL
# the goal itself: 8 answers, at most 0.0000 mm and 180.0000 degrees off
# the goal without the turn at 0: 8 answers, at most 0.0000 mm and 0.0000 degrees off
