#!/usr/bin/env bash
# mujoco-mjx 3.17.0 with mujoco 3.17.0: mjx.put_model() takes models of which it simulates a part only.
#
# A good guess is that MJX refuses what it cannot do, as put_model() does raise NotImplementedError for
# much, and that a model it takes moves as in MuJoCo, as most do to the last digit. Left out without a
# word are an actuator's delay, actuatorgroupdisable and the higher terms of damping and stiffness, and
# <flag spring="disable"/> switches the dampers off as well. A policy that is trained with a delay
# against the real arm's latency is trained without one; a disabled actuator pushes. The slide here
# weighs 1 kg without gravity, so that what is right can be written down: MuJoCo agrees with it.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'mujoco-mjx==3.17.0' 'mujoco==3.17.0' 'jax==0.10.2'

JAX_PLATFORMS=cpu "$folder/venv/bin/python" -W ignore - <<'PYTHON' | grep 'mujoco-mjx\|m/s\|changed'
import sys
from importlib.metadata import version

import jax
import mujoco
import numpy as np
from mujoco import mjx

jax.config.update("jax_enable_x64", True)
SLIDE = """<mujoco><option gravity="0 0 0" timestep="0.001" {option}>{flag}</option>
  <worldbody><body><joint name="slide" type="slide" axis="1 0 0" {joint}/>
    <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></worldbody>
  <actuator>{actuator}</actuator></mujoco>"""
MOTOR = '<motor joint="slide" {more}/>'
PARTS = dict.fromkeys(("option", "flag", "joint", "actuator"), "")
Q, V, CONTROL, STEPS = 0.5, 2.0, 1.0, 50
# The model, and how fast the slide is after 50 ms from the place Q and the speed V, nearly.
CASES = {
    "a motor": ({"actuator": MOTOR.format(more="")}, V + CONTROL * 0.05),
    "delay of 0.1 s": ({"actuator": MOTOR.format(more='delay="0.1" nsample="101"')}, V),
    "a disabled group": (
        {"option": 'actuatorgroupdisable="1"', "actuator": MOTOR.format(more='group="1"')},
        V,
    ),
    "a spring": ({"joint": 'stiffness="10"'}, V - 10 * Q * 0.05 - 10 * V * 0.05**2 / 2),
    "damping of 3 v": ({"joint": 'damping="3"'}, V * np.exp(-3 * 0.05)),
    "the same, springs off": (
        {"joint": 'damping="3"', "flag": '<flag spring="disable"/>'},
        V * np.exp(-3 * 0.05),
    ),
    "damping of 3 v |v|": ({"joint": 'damping="0 3"'}, V / (1 + 3 * V * 0.05)),
}


def speeds(parts: dict[str, str]) -> tuple[float, float]:
    """Return the speed of the slide in MJX and in MuJoCo."""
    model = mujoco.MjModel.from_xml_string(SLIDE.format(**PARTS | parts))
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:], data.ctrl[:] = Q, V, CONTROL
    other, state = mjx.put_model(model), mjx.put_data(model, data)
    step = jax.jit(mjx.step)
    for _ in range(STEPS):
        mujoco.mj_step(model, data)
        state = step(other, state)
    return float(state.qvel[0]), float(data.qvel[0])


print("mujoco-mjx", version("mujoco-mjx"), "mujoco", version("mujoco"), flush=True)
right = []
for name, (parts, true) in CASES.items():
    mjx_speed, speed = speeds(parts)
    print(f"{name}: MJX {mjx_speed:.3f}, MuJoCo {speed:.3f}, by hand {true:.3f} m/s", flush=True)
    right.append((bool(np.isclose(mjx_speed, true, atol=0.02)), bool(np.isclose(speed, true, atol=0.02))))
if right != [(name in ("a motor", "a spring", "damping of 3 v"), True) for name in CASES]:
    print("the behaviour has changed")
    sys.exit(1)
PYTHON
# Output seen:
# mujoco-mjx 3.17.0 mujoco 3.17.0
# a motor: MJX 2.050, MuJoCo 2.050, by hand 2.050 m/s
# delay of 0.1 s: MJX 2.050, MuJoCo 2.000, by hand 2.000 m/s
# a disabled group: MJX 2.050, MuJoCo 2.000, by hand 2.000 m/s
# a spring: MJX 1.727, MuJoCo 1.727, by hand 1.725 m/s
# damping of 3 v: MJX 1.722, MuJoCo 1.722, by hand 1.721 m/s
# the same, springs off: MJX 2.000, MuJoCo 1.722, by hand 1.721 m/s
# damping of 3 v |v|: MJX 2.000, MuJoCo 1.540, by hand 1.538 m/s
