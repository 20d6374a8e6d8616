#!/usr/bin/env bash
# newton 1.8.0, mujoco 4.0.0: of a body with a hinge and then a slide, add_mjcf() makes another mechanism.
#
# Two joints of one body act one after the other in MuJoCo: a slide that is written after a hinge turns with
# it, as in a telescope on a turntable. A good guess is that a reader of MJCF keeps that, as newton does for
# hinge and hinge, or refuses it. newton puts all joints of the body into one joint with its linear
# axes first. So the slide keeps its direction in the parent, the tip of a telescope that was turned by 90
# degrees still reaches along x, and the coordinates change places: q is [slide, hinge] although the file and
# qpos say [hinge, slide]. With the slide written first, or with a body between, the two agree. Two hinges
# whose pos differ (a cardan with offset axes) are wrong as well. Nothing is said.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'newton==1.8.0' 'warp-lang==1.19.0' 'mujoco==4.0.0' 'numpy==2.4.6'

WARP_CACHE_PATH="$folder/kernels" "$folder/venv/bin/python" -W ignore - 2>"$folder/said" <<'PYTHON' || { tail -n 5 "$folder/said"; exit 1; }
import contextlib
import io
import sys
from importlib.metadata import version

import mujoco
import newton
import numpy as np
import warp

TIP = '<geom size="0.1"/><body name="tip" pos="0.1 0 0"><geom size="0.1"/></body>'
HINGE = '<joint axis="0 0 1"/>'
SLIDE = '<joint type="slide" axis="1 0 0"/>'
TURN, REACH = np.pi / 2, 0.2
# The joints and what they carry, and the coordinates in the order of the file.
MODELS = {
    "hinge, slide": (f"<body>{HINGE}{SLIDE}{TIP}</body>", (TURN, REACH)),
    "slide, hinge": (f"<body>{SLIDE}{HINGE}{TIP}</body>", (REACH, TURN)),
    "hinge, body, slide": (f'<body>{HINGE}<geom size="0.1"/><body>{SLIDE}{TIP}</body></body>', (TURN, REACH)),
    "hinge, hinge": (f'<body>{HINGE}<joint axis="0 1 0"/>{TIP}</body>', (TURN, TURN)),
    "hinge, hinge elsewhere": (f'<body>{HINGE}<joint axis="0 1 0" pos="-0.1 0 0"/>{TIP}</body>', (TURN, TURN)),
}


def in_mujoco(xml: str, values: tuple[float, float]) -> np.ndarray:
    """Return the tip's place in m."""
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    data.qpos[:] = values
    mujoco.mj_kinematics(model, data)
    return data.body("tip").xpos.copy()


def in_newton(xml: str, values: tuple[float, float]) -> np.ndarray:
    """Return the tip's place in m."""
    builder = newton.ModelBuilder()
    builder.add_mjcf(xml)
    model = builder.finalize(device="cpu")
    state = model.state()
    places = warp.array(np.array(values, np.float32), dtype=warp.float32, device="cpu")
    newton.eval_fk(model, places, model.joint_qd, state)
    return state.body_q.numpy()[-1][:3].astype(float)


print("newton", version("newton"), "mujoco", mujoco.__version__)
found = []
for name, (bodies, values) in MODELS.items():
    xml = f"<mujoco><worldbody>{bodies}</worldbody></mujoco>"
    with contextlib.redirect_stdout(io.StringIO()):  # what Warp says while it compiles
        true, same, swapped = in_mujoco(xml, values), in_newton(xml, values), in_newton(xml, values[::-1])
    found.append((np.allclose(true, same, atol=1e-4), np.allclose(true, swapped, atol=1e-4)))
    shown = [str((np.round(place, 3) + 0.0).tolist()) for place in (true, same, swapped)]
    print(f"{name}: MuJoCo {shown[0]}, newton {shown[1]}, with the coordinates exchanged {shown[2]}")
if [same for same, _ in found] != [False, True, True, True, False] or found[0][1]:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# newton 1.8.0 mujoco 4.0.0
# hinge, slide: MuJoCo [0.0, 0.3, 0.0], newton [1.669, 0.02, 0.0], with the coordinates exchanged [0.2, 0.1, 0.0]
# slide, hinge: MuJoCo [0.2, 0.1, 0.0], newton [0.2, 0.1, 0.0], with the coordinates exchanged [1.669, 0.02, 0.0]
# hinge, body, slide: MuJoCo [0.0, 0.3, 0.0], newton [0.0, 0.3, 0.0], with the coordinates exchanged [1.637, 0.332, 0.0]
# hinge, hinge: MuJoCo [0.0, 0.0, -0.1], newton [0.0, 0.0, -0.1], with the coordinates exchanged [0.0, 0.0, -0.1]
# hinge, hinge elsewhere: MuJoCo [0.0, -0.1, -0.2], newton [0.0, 0.0, -0.1], with the coordinates exchanged [0.0, 0.0, -0.1]
