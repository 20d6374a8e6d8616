#!/usr/bin/env bash
# tesseract-robotics 0.5.1: a continuous joint has a greatest velocity of 0 and ends after two turns.
#
# A continuous joint turns without end, and URDF lets it leave <limit> out, as the wheels, turntables and wrists
# of many files do. A good guess is no limits, or those of a default. The joint group's limits are then -4 pi to
# 4 pi, so that checkJoints() refuses a spindle at 13 rad, and a velocity and acceleration of 0, at which no
# timing can move it. With <limit effort velocity> the velocity is taken, and two turns each way stay the
# range. If lower and upper are written, which for a continuous joint mean nothing, they hold: a joint that
# MuJoCo and Pinocchio turn freely stops at 1 rad. The acceleration limit, which URDF has no word for, is
# half of the velocity's number throughout.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'tesseract-robotics==0.5.1' 'numpy==2.4.6' 'pin==4.1.0'

"$folder/venv/bin/python" - 2>"$folder/said" <<'PYTHON' || { tail -n 5 "$folder/said"; exit 1; }
import sys
from importlib.metadata import version

import numpy as np
import pinocchio
from tesseract_robotics.tesseract_common import GeneralResourceLocator
from tesseract_robotics.tesseract_environment import Environment

URDF = """<robot name="arm"><link name="base"/><link name="hand"/>
  <joint name="wrist" type="continuous"><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/>{limit}</joint>
  </robot>"""
SRDF = '<robot name="arm"><group name="arm"><chain base_link="base" tip_link="hand"/></group></robot>'
LIMITS = ("", '<limit effort="5" velocity="2"/>', '<limit lower="-1" upper="1" effort="5" velocity="2"/>')

print("tesseract-robotics", version("tesseract-robotics"), "pin", version("pin"))
found = []
for limit in LIMITS:
    urdf = URDF.format(limit=limit)
    environment = Environment()
    if not environment.init(urdf, SRDF, GeneralResourceLocator()):
        sys.exit("the robot was not taken")
    group = environment.getJointGroup("arm")
    limits = group.getLimits()
    allowed = [bool(group.checkJoints(np.array([angle]))) for angle in (0.5, 3.0, 13.0)]
    found.append(
        (
            *(float(np.ravel(values)[1]) for values in (limits.joint_limits, limits.velocity_limits)),
            float(np.ravel(limits.acceleration_limits)[1]),
            allowed,
            pinocchio.buildModelFromXML(urdf).nq == 2,  # a cosine and a sine, without limits
        )
    )
    upper, velocity, acceleration, allowed, free = found[-1]
    print(f"{limit or 'no <limit>'}:")
    print(f"   tesseract: up to {upper:.2f} rad, {velocity:.1f} rad/s, {acceleration:.1f} rad/s2")
    print(f"   tesseract: checkJoints at 0.5, 3 and 13 rad {allowed}; pin turns without end: {free}")
expected = [
    (4 * np.pi, 0.0, 0.0, [True, True, False], True),
    (4 * np.pi, 2.0, 1.0, [True, True, False], True),
    (1.0, 2.0, 1.0, [True, False, False], True),
]
if not all(np.allclose(f[:3], e[:3]) and f[3:] == e[3:] for f, e in zip(found, expected)):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# tesseract-robotics 0.5.1 pin 4.1.0
# no <limit>:
#    tesseract: up to 12.57 rad, 0.0 rad/s, 0.0 rad/s2
#    tesseract: checkJoints at 0.5, 3 and 13 rad [True, True, False]; pin turns without end: True
# <limit effort="5" velocity="2"/>:
#    tesseract: up to 12.57 rad, 2.0 rad/s, 1.0 rad/s2
#    tesseract: checkJoints at 0.5, 3 and 13 rad [True, True, False]; pin turns without end: True
# <limit lower="-1" upper="1" effort="5" velocity="2"/>:
#    tesseract: up to 1.00 rad, 2.0 rad/s, 1.0 rad/s2
#    tesseract: checkJoints at 0.5, 3 and 13 rad [True, False, False]; pin turns without end: True
