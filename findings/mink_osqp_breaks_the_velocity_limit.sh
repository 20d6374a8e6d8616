#!/usr/bin/env bash
# mink 1.3.0 and pin-pink 4.4.0 with osqp 1.1.3: the shorter the time step, the more a velocity limit is broken.
#
# solve_ik(..., solver="osqp") has the joints' velocity limits as hard constraints. A good guess is that they
# hold to OSQP's usual thousandth, as they do exactly with daqp or quadprog. The unknown is the step, v * dt,
# and OSQP's tolerance is a thousandth of a radian on it: divided by dt the error of a velocity grows without a
# bound. A joint that is limited to 0.5 rad/s is asked for 0.62 to 0.67 at 1 kHz here, and for 0.501 at 10 Hz, from
# the same pose to the same target. Both libraries say that a solution was found. eps_abs=1e-9, eps_rel=1e-9, passed on to
# OSQP, bring the limits back.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'mink==1.3.0' 'mujoco==4.0.0' 'pin-pink==4.4.0' 'pin==4.0.0' 'qpsolvers==4.13.0' \
  'osqp==1.1.3' 'daqp==0.11.0' 'numpy==2.4.6'

"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import sys
from importlib.metadata import version

import mink
import mujoco
import numpy as np
import pink
import pinocchio

LIMIT = 0.5
MJCF = """<mujoco><worldbody><body name="upper"><joint name="first" axis="0 0 1"/><geom size="0.1"/>
  <body pos="0.3 0 0"><joint name="second" axis="0 1 0"/><geom size="0.05"/>
  <site name="tip" pos="0.3 0 0"/></body></body></worldbody></mujoco>"""
JOINT = """<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>
  <origin xyz="{at} 0 0"/><axis xyz="{axis}"/><limit lower="-3" upper="3" effort="9" velocity="0.5"/></joint>"""
URDF = f"""<robot name="arm"><link name="base"/><link name="upper"/><link name="lower"/><link name="tip"/>
  {JOINT.format(name="first", parent="base", child="upper", at=0, axis="0 0 1")}
  {JOINT.format(name="second", parent="upper", child="lower", at=0.3, axis="0 1 0")}
  <joint name="flange" type="fixed"><parent link="lower"/><child link="tip"/><origin xyz="0.3 0 0"/></joint></robot>"""
TARGET = np.array([0.5, 0.1, -0.1])
EXACT = {"solver": "osqp", "eps_abs": 1e-9, "eps_rel": 1e-9, "max_iter": 100_000}


def by_mink(dt: float, **how: object) -> float:
    """Return the greatest joint velocity of a step of dt, in rad/s."""
    model = mujoco.MjModel.from_xml_string(MJCF)
    arm = mink.Configuration(model, np.zeros(2))
    task = mink.FrameTask("tip", "site", position_cost=1.0, orientation_cost=0.0)
    task.set_target(mink.SE3.from_translation(TARGET))
    limits = [mink.VelocityLimit(model, {"first": LIMIT, "second": LIMIT})]
    return float(np.abs(mink.solve_ik(arm, [task], dt, limits=limits, **how)).max())


def by_pink(dt: float, **how: object) -> float:
    """Return the greatest joint velocity of a step of dt, in rad/s."""
    model = pinocchio.buildModelFromXML(URDF)
    arm = pink.Configuration(model, model.createData(), np.zeros(2))
    task = pink.FrameTask("tip", position_cost=1.0, orientation_cost=0.0)
    task.set_target(pinocchio.SE3(np.eye(3), TARGET))
    return float(np.abs(pink.solve_ik(arm, [task], dt, **how)).max())


print(*(f"{name} {version(name)}" for name in ("mink", "pin-pink", "osqp")))
found = []
for dt in (0.1, 0.01, 0.001):
    for name, solve in (("mink", by_mink), ("pink", by_pink)):
        ways = ({"solver": "daqp"}, {"solver": "osqp"}, EXACT)
        daqp, osqp, exact = (solve(dt, **how) for how in ways)
        found.append((daqp, osqp, exact))
        print(f"{name}, dt {dt} s: daqp {daqp:.4f} rad/s, osqp {osqp:.4f}, osqp with eps_abs=1e-9 {exact:.4f}")
daqp, osqp, exact = np.array(found).T
rising = osqp.reshape(3, 2)
if not (
    np.allclose(daqp, LIMIT, atol=1e-6)
    and np.allclose(exact, LIMIT, atol=1e-4)
    and (rising[0] < 1.01 * LIMIT).all()
    and (rising[2] > 1.1 * LIMIT).all()
):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# mink 1.3.0 pin-pink 4.4.0 osqp 1.1.3
# mink, dt 0.1 s: daqp 0.5000 rad/s, osqp 0.5010, osqp with eps_abs=1e-9 0.5000
# pink, dt 0.1 s: daqp 0.5000 rad/s, osqp 0.5014, osqp with eps_abs=1e-9 0.5000
# mink, dt 0.01 s: daqp 0.5000 rad/s, osqp 0.5117, osqp with eps_abs=1e-9 0.5000
# pink, dt 0.01 s: daqp 0.5000 rad/s, osqp 0.5164, osqp with eps_abs=1e-9 0.5000
# mink, dt 0.001 s: daqp 0.5000 rad/s, osqp 0.6184, osqp with eps_abs=1e-9 0.5000
# pink, dt 0.001 s: daqp 0.5000 rad/s, osqp 0.6660, osqp with eps_abs=1e-9 0.5000
