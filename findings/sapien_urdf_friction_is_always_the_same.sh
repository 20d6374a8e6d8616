#!/usr/bin/env bash
# sapien 3.0.3: every joint of a URDF has PhysX's friction 0.05; the file's friction and effort are dropped.
#
# A good guess is that <dynamics friction> becomes the joint's friction, or 0 if it is absent: the reader
# parses it and hands it to its builder. The builder sets damping and limits alone, so that a joint
# keeps what PhysX gives a new one, whatever the file says. A turntable without friction that is set
# going at 1 rad/s stands still a quarter of a second later, and so do one with 0.4 N m and one with
# friction="0". joint.friction = 0 by hand lets it run; what is lost then is PhysX's angular damping of
# 0.05 per second. <limit effort> is dropped, too: force_limit is the largest float. MuJoCo and
# PyBullet read both from the same file.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'sapien==3.0.3'

"$folder/venv/bin/python" -W ignore - "$folder/turntable.urdf" <<'PYTHON'
import math
import sys
from importlib.metadata import version

import numpy as np
import sapien

path = sys.argv[1]
TURNTABLE = """<robot name="turntable"><link name="base"/><link name="plate"><inertial><mass value="1"/>
  <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="turn" type="continuous"><parent link="base"/><child link="plate"/>
    <axis xyz="0 0 1"/><limit effort="2" velocity="20"/>{dynamics}</joint></robot>"""


def run(dynamics: str, by_hand: bool) -> tuple[float, float, float, float]:
    """Return friction, force limit, and the speed 0.25 and 1 s after a start at 1 rad/s."""
    with open(path, "w") as file:
        file.write(TURNTABLE.format(dynamics=dynamics))
    scene = sapien.Scene([sapien.physx.PhysxCpuSystem()])
    scene.set_timestep(0.001)
    loader = scene.create_urdf_loader()
    loader.fix_root_link = True
    robot = loader.load(path)
    (joint,) = robot.active_joints
    if by_hand:
        joint.friction = 0
    robot.set_qvel([1.0])
    speeds = []
    for _ in range(1000):
        scene.step()
        speeds.append(float(robot.get_qvel()[0]))
    return joint.friction, joint.force_limit, speeds[249], speeds[-1]


print("sapien", version("sapien"))
CASES = {
    "no <dynamics>": ("", False),
    'friction="0"': ('<dynamics damping="0" friction="0"/>', False),
    'friction="0.4"': ('<dynamics damping="0" friction="0.4"/>', False),
    "0 by hand": ("", True),
}
found = {name: run(*case) for name, case in CASES.items()}
for name, (friction, limit, early, late) in found.items():
    print(f"{name}: friction {friction:.2f}, force limit {limit:.3g}; {early:.4f}, {late:.4f} rad/s")
expected = [(0.05, 0, 0)] * 3 + [(0, math.exp(-0.05 / 4), math.exp(-0.05))]
seen = [(friction, early, late) for friction, _, early, late in found.values()]
if not np.allclose(seen, expected, atol=1e-4):
    sys.exit("the behaviour has changed")
if not all(limit > 1e38 for _, limit, _, _ in found.values()):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# sapien 3.0.3
# no <dynamics>: friction 0.05, force limit 3.4e+38; 0.0000, 0.0000 rad/s
# friction="0": friction 0.05, force limit 3.4e+38; 0.0000, 0.0000 rad/s
# friction="0.4": friction 0.05, force limit 3.4e+38; 0.0000, 0.0000 rad/s
# 0 by hand: friction 0.00, force limit 3.4e+38; 0.9876, 0.9512 rad/s
