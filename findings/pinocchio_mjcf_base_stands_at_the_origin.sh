#!/usr/bin/env bash
# pin 4.1.0 (Pinocchio): buildModelFromMJCF() drops the pose of a fixed base, and every arm but the first.
#
# A good guess is that an MJCF file means the robot that MuJoCo simulates: for joints, defaults, angles,
# ranges and masses from shapes it does. The first body of <worldbody>, if it has no joint, is put at
# the origin, unturned: an arm that hangs on a wall is computed as if it stood on the floor, with other
# torques against gravity and every frame at another place. The same base in an outer body keeps its
# pose. Of two arms side by side in <worldbody> the second is not there at all, nor are its joints.
# Nothing is said. MuJoCo 4.0.0 reads the same files; the torque that is right is also written down
# here by hand. Upstream the pose is issue 2782, mended on the main branch after 4.1.0.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'pin==4.1.0' 'mujoco==4.0.0'

"$folder/venv/bin/python" - "$folder/arm.xml" <<'PYTHON'
import sys
from importlib.metadata import version

import mujoco
import numpy as np
import pinocchio

path = sys.argv[1]
ARM = """<body name="{side}base" {pose}><geom size="0.1"/>
  <body name="{side}link"><joint name="{side}joint" axis="0 1 0"/>
    <inertial pos="0.3 0 0" mass="2" diaginertia="0.01 0.01 0.01"/></body></body>"""
ON_THE_WALL = ARM.format(side="", pose='pos="0 0 1.5" euler="0 90 0"')
FILES = {
    "on the wall": ON_THE_WALL,
    "in a body": f'<body name="wall">{ON_THE_WALL}</body>',
    "two arms": ARM.format(side="left_", pose='pos="0 0.4 0"')
    + ARM.format(side="right_", pose='pos="0 -0.4 0"'),
}


def holding(bodies: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the torques that hold the arms at zero, of Pinocchio and of MuJoCo, in N m."""
    with open(path, "w") as file:
        file.write(f"<mujoco><worldbody>{bodies}</worldbody></mujoco>")
    built = pinocchio.buildModelFromMJCF(path)
    model = built if isinstance(built, pinocchio.Model) else built[0]
    zero = pinocchio.neutral(model)
    torques = pinocchio.computeGeneralizedGravity(model, model.createData(), zero)
    simulated = mujoco.MjModel.from_xml_path(path)
    data = mujoco.MjData(simulated)
    mujoco.mj_forward(simulated, data)
    return torques + 0.0, data.qfrc_bias + 0.0


print("pin", version("pin"), "MuJoCo", version("mujoco"))
found = {name: holding(bodies) for name, bodies in FILES.items()}
for name, (pinned, simulated) in found.items():
    print(f"{name}: Pinocchio {pinned.round(3)} N m, MuJoCo {simulated.round(3)} N m")
LYING = -2 * 9.81 * 0.3
expected = {
    "on the wall": ([LYING], [0]),
    "in a body": ([0], [0]),
    "two arms": ([LYING], [LYING, LYING]),
}
if any(
    len(one) != len(other) or not np.allclose(one, other, atol=1e-6)
    for name in expected
    for one, other in zip(found[name], expected[name], strict=True)
):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# pin 4.1.0 MuJoCo 4.0.0
# on the wall: Pinocchio [-5.886] N m, MuJoCo [-0.] N m
# in a body: Pinocchio [-0.] N m, MuJoCo [-0.] N m
# two arms: Pinocchio [-5.886] N m, MuJoCo [-5.886 -5.886] N m
