#!/usr/bin/env bash
# dm-control 1.0.50: attaching an arm with angle="radian" makes radians of the degrees that the scene was written in.
#
# In MJCF angles are degrees unless <compiler> says otherwise, and eulerseq is "xyz". A good guess is that
# mjcf's attach() keeps each file's meaning, as MuJoCo's own MjSpec.attach() does, or refuses what does not
# fit, as it does if both files say angle and differ. What the scene leaves to the standard it takes
# from the arm: most arms of MuJoCo's Menagerie say angle="radian", and a shelf with euler="0 0 90" then
# stands at 90 radians (116.6 degrees), its door with range="-90 90" turns without limits. eulerseq and
# boundmass of the arm hold for the scene as well, and so do timestep, integrator and gravity of its
# <option>. Nothing is said. <compiler angle="degree"/> in the scene turns the first into an error.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'dm-control==1.0.50' 'mujoco==3.17.0' 'numpy==2.4.6'

"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import sys
from importlib.metadata import version

import mujoco
import numpy as np
from dm_control import mjcf

SCENE = """<mujoco model="scene">{compiler}<worldbody><site name="mount"/><body name="shelf" euler="{euler}">
  <joint name="door" range="-90 90"/><geom size="0.1" mass="0.5"/></body></worldbody></mujoco>"""
ARM = """<mujoco model="arm"><compiler {compiler}/><option {option}/><worldbody><body name="link">
  <joint name="turn"/><geom size="0.1"/></body></worldbody></mujoco>"""


def seen(model: mujoco.MjModel) -> tuple[np.ndarray, float, float, float]:
    """Return the shelf's attitude, the door's upper limit in degrees, the shelf's mass and the time step."""
    limit = np.degrees(model.joint("door").range[1])
    return model.body("shelf").quat.round(3), round(limit, 1), model.body("shelf").mass[0], model.opt.timestep


def attached(compiler: str, option: str = "", euler: str = "0 0 90", own: str = "") -> tuple[tuple, tuple, tuple]:
    """Return what is seen of the scene alone, after attach() of dm_control, and after that of MjSpec."""
    scene, arm = SCENE.format(euler=euler, compiler=own), ARM.format(compiler=compiler, option=option)
    alone = seen(mujoco.MjModel.from_xml_string(scene))
    root = mjcf.from_xml_string(scene)
    root.find("site", "mount").attach(mjcf.from_xml_string(arm))
    after = seen(mujoco.MjModel.from_xml_string(root.to_xml_string()))
    spec = mujoco.MjSpec.from_string(scene)
    spec.attach(mujoco.MjSpec.from_string(arm), site=spec.site("mount"), prefix="arm/")
    return alone, after, seen(spec.compile())


def same(first: tuple, second: tuple) -> bool:
    """Return whether the same is seen."""
    return np.allclose(first[0], second[0], atol=2e-3) and np.allclose(first[1:], second[1:])


print("dm-control", version("dm-control"), "mujoco", version("mujoco"))
cases = {
    'angle="radian"': attached('angle="radian"'),
    'eulerseq="zyx"': attached('eulerseq="zyx"', euler="10 20 90"),
    'boundmass="2"': attached('boundmass="2"'),
    'timestep="0.001"': attached("", 'timestep="0.001"'),
}
right = []
for name, (alone, after, spec) in cases.items():
    print(f"{name} in the arm; quaternion, limit in degrees, mass, time step of the scene")
    print("   alone:", *alone)
    print("   dm_control:", *after)
    print("   MjSpec:", *spec)
    right += [not same(alone, after), same(alone, spec)]
try:
    attached('angle="radian"', own='<compiler angle="degree"/>')
    message = ""
except ValueError as error:
    message = str(error)
print("both say angle:", message)
if not all(right) or not message.startswith("Conflicting values"):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# dm-control 1.0.50 mujoco 3.17.0
# angle="radian" in the arm; quaternion, limit in degrees, mass, time step of the scene
#    alone: [0.707 0.    0.    0.707] 90.0 0.5 0.002
#    dm_control: [0.525 0.    0.    0.851] 5156.6 0.5 0.002
#    MjSpec: [0.707 0.    0.    0.707] 90.0 0.5 0.002
# eulerseq="zyx" in the arm; quaternion, limit in degrees, mass, time step of the scene
#    alone: [0.683 0.183 0.062 0.704] 90.0 0.5 0.002
#    dm_control: [ 0.704  0.683  0.183 -0.062] 90.0 0.5 0.002
#    MjSpec: [0.683 0.183 0.062 0.704] 90.0 0.5 0.002
# boundmass="2" in the arm; quaternion, limit in degrees, mass, time step of the scene
#    alone: [0.707 0.    0.    0.707] 90.0 0.5 0.002
#    dm_control: [0.707 0.    0.    0.707] 90.0 2.0 0.002
#    MjSpec: [0.707 0.    0.    0.707] 90.0 0.5 0.002
# timestep="0.001" in the arm; quaternion, limit in degrees, mass, time step of the scene
#    alone: [0.707 0.    0.    0.707] 90.0 0.5 0.002
#    dm_control: [0.707 0.    0.    0.707] 90.0 0.5 0.001
#    MjSpec: [0.707 0.    0.    0.707] 90.0 0.5 0.002
# both say angle: Conflicting values for attribute `angle`: degree vs radian
