#!/usr/bin/env bash
# brax 0.14.2, mujoco 4.0.0: a joint's ref turns the arm in its start, and its limits with it.
#
# ref="30" says which number the joint has in the pose of the file: qpos0 is 30 degrees, and the limits
# count from there. A good guess is that brax.io.mjcf, which lets MuJoCo compile the file, gives the same
# arm. It takes init_q from qpos0 and the range from jnt_range, both with the ref, but its kinematics never
# subtracts it: the arm starts 30 degrees away from where it is drawn, and a joint that may go 30
# degrees either way may go from 0 to 60. A position servo holds it at the wrong pose. Lengths, masses and all
# arms without ref agree. Nothing is said.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'brax==0.14.2' 'mujoco==4.0.0' 'mujoco-mjx==3.17.0' 'jax==0.10.2' 'numpy==2.4.6'

JAX_PLATFORMS=cpu "$folder/venv/bin/python" -W ignore - 2>"$folder/said" <<'PYTHON' || { tail -n 5 "$folder/said"; exit 1; }
import sys
from importlib.metadata import version

import jax.numpy as jnp
import mujoco
import numpy as np
from brax import kinematics
from brax.io import mjcf

XML = """<mujoco><worldbody><body name="arm">
  <joint axis="0 0 1" range="{low} {high}" ref="{ref}"/><geom size="0.1"/>
  <body name="tip" pos="0.3 0 0"><joint axis="0 1 0"/><geom size="0.1"/></body></body></worldbody></mujoco>"""


def degrees(place: np.ndarray) -> float:
    """Return where the tip is, as an angle about z from the file's pose."""
    return float(np.degrees(np.arctan2(place[1], place[0])))


def in_mujoco(model: mujoco.MjModel, joint: float) -> float:
    """Return the tip's angle for a value of the first joint."""
    data = mujoco.MjData(model)
    data.qpos[0] = joint
    mujoco.mj_kinematics(model, data)
    return degrees(data.body("tip").xpos)


def in_brax(system: object, joint: float) -> float:
    """Return the tip's angle for a value of the first joint."""
    places, _ = kinematics.forward(system, jnp.array([joint, 0.0]), jnp.zeros(2))
    return degrees(np.array(places.pos[1]))


print("brax", version("brax"), "mujoco", mujoco.__version__)
found = []
for ref in (0, 30):
    xml = XML.format(ref=ref, low=ref - 30, high=ref + 30)
    model, system = mujoco.MjModel.from_xml_string(xml), mjcf.loads(xml)
    (low,), (high,) = (np.array(limit)[:1] for limit in system.dof.limit)
    seen = {
        "MuJoCo": [in_mujoco(model, joint) for joint in (model.qpos0[0], *model.jnt_range[0])],
        "brax": [in_brax(system, joint) for joint in (float(system.init_q[0]), low, high)],
    }
    for name, (start, least, most) in seen.items():
        print(f"ref {ref}: {name} starts at {start:.0f} degrees and may go from {least:.0f} to {most:.0f}")
        found += [start, least, most]
if not np.allclose(found, [0, -30, 30, 0, -30, 30, 0, -30, 30, 30, 0, 60], atol=0.01):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# Failed to import warp: No module named 'warp'
# Failed to import mujoco_warp: No module named 'warp'
# brax 0.14.2 mujoco 4.0.0
# ref 0: MuJoCo starts at 0 degrees and may go from -30 to 30
# ref 0: brax starts at 0 degrees and may go from -30 to 30
# ref 30: MuJoCo starts at 0 degrees and may go from -30 to 30
# ref 30: brax starts at 30 degrees and may go from 0 to 60
