#!/usr/bin/env bash
# mujoco-core 4.0.1: a force sensor below a body whose gravity is compensated reads the body's whole weight.
#
# A good guess is that gravcomp="1" makes a body weightless for whatever carries it: it falls no more, a
# joint that carries it needs no effort, and so nothing should pull at a sensor between the two. The sensor
# reads m g all the same, 9.81 N for 1 kg at rest, as without gravcomp, because the compensation is a passive
# force on the joints' coordinates, of which the forces between bodies (cfrc_int) know nothing. The same
# model so has a joint that bears 0 N and a sensor in that joint that reads 9.81 N. A gripper that is
# compensated in the model, as many arms' are, still has to be tared in a wrist's force sensor.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'mujoco-core==4.0.1' 'numpy==2.4.6'
cd "$folder"
"$folder/venv/bin/python" - <<'PYTHON'
import sys

import mujoco

LIFT = """<mujoco><worldbody><body name="load" gravcomp="{compensated}">
<joint name="lift" type="slide" axis="0 0 1"/><geom size="0.05" mass="1"/><site name="wrist"/>
</body></worldbody>
<actuator><position name="hold" joint="lift" kp="1e4" kv="100"/></actuator>
<sensor><force site="wrist"/></sensor></mujoco>"""

print("mujoco-core", mujoco.__version__)
readings = {}
for compensated in (0, 1):
    model = mujoco.MjModel.from_xml_string(LIFT.format(compensated=compensated))
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 2000)
    mujoco.mj_forward(model, data)
    readings[compensated] = float(data.actuator_force[0]), float(data.sensordata[2])
    borne, felt = readings[compensated]
    print(f"gravcomp={compensated}: the joint's drive bears {borne:.2f} N, the sensor reads {felt:.2f} N")
if abs(readings[1][0]) > 1e-3 or abs(readings[1][1] - 9.81) > 1e-3 or abs(readings[0][0] - 9.81) > 1e-3:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# mujoco-core 4.0.1
# gravcomp=0: the joint's drive bears 9.81 N, the sensor reads 9.81 N
# gravcomp=1: the joint's drive bears 0.00 N, the sensor reads 9.81 N
