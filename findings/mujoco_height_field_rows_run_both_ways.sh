#!/usr/bin/env bash
# mujoco 4.0.0, coal 3.0.3: the first row of a height field lies at one side or the other, by how it is given.
#
# A good guess is that the same numbers make the same ground. In <hfield elevation> the first row lies at
# the greatest y; in a binary file of <hfield file>, in the userdata of MjSpec.add_hfield() and in
# model.hfield_data at the least y. So rows that are written into a running model, or built with MjSpec,
# are the mirror image of the same rows in the text: the step here is at the other end. Coal puts the
# first row at the greatest y, as its getYGrid() says, so a planner that is given
# model.hfield_data.reshape(nrow, ncol) plans on the mirrored ground. numpy.flipud() makes them agree.
# Nothing complains, and ground that is symmetric hides it.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'mujoco==4.0.0' 'coal==3.0.3'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import coal
import mujoco
import numpy as np

ROWS = np.array([[1.0, 1, 1, 1], [0, 0, 0, 0], [0, 0, 0, 0]])
SIZE = (2.0, 1.0, 1.0, 0.1)
FIELD = """<mujoco><asset><hfield name="ground" nrow="3" ncol="4" size="2 1 1 0.1" {rows}/></asset>
  <worldbody><geom type="hfield" hfield="ground"/></worldbody></mujoco>"""
PLACES = (-0.9, 0.9)


def heights(model: mujoco.MjModel) -> list[float]:
    """Return the height of the ground at the least and at the greatest y, by a ray from above."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    hit = np.zeros(1, np.int32)
    down = np.array([0.0, 0, -1])
    rays = (np.array([0.3, y, 5.0]) for y in PLACES)
    return [round(5 - mujoco.mj_ray(model, data, ray, down, None, 1, -1, hit), 3) + 0.0 for ray in rays]


def from_text() -> list[float]:
    """Return the heights for rows in <hfield elevation>."""
    text = " ".join(str(value) for value in ROWS.flat)
    return heights(mujoco.MjModel.from_xml_string(FIELD.format(rows=f'elevation="{text}"')))


def from_binary() -> list[float]:
    """Return the heights for rows in a binary file of MuJoCo's own format."""
    content = np.array(ROWS.shape, np.int32).tobytes() + ROWS.astype(np.float32).tobytes()
    text = FIELD.format(rows='file="ground.bin"').replace('nrow="3" ncol="4"', "")
    return heights(mujoco.MjModel.from_xml_string(text, {"ground.bin": content}))


def from_model() -> list[float]:
    """Return the heights for rows that are written into the model."""
    model = mujoco.MjModel.from_xml_string(FIELD.format(rows=""))
    model.hfield_data[:] = ROWS.ravel()
    return heights(model)


def from_spec() -> list[float]:
    """Return the heights for rows that are given to MjSpec."""
    spec = mujoco.MjSpec()
    spec.add_hfield(name="ground", nrow=3, ncol=4, size=SIZE, userdata=ROWS.ravel())
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_HFIELD, hfieldname="ground")
    return heights(spec.compile())


def from_coal() -> list[float]:
    """Return the heights of Coal's field: 0.9 where a small ball at 0.6 m touches it, or 0."""
    field = coal.HeightFieldOBBRSS(2 * SIZE[0], 2 * SIZE[1], ROWS, -0.1)
    found = []
    for y in PLACES:
        place = coal.Transform3s()
        place.setTranslation(np.array([0.3, y, 0.6]))
        result = coal.CollisionResult()
        ball, request = coal.Sphere(0.05), coal.CollisionRequest()
        coal.collide(field, coal.Transform3s(), ball, place, request, result)
        found.append(0.9 if result.isCollision() else 0.0)
    return found


print("mujoco", version("mujoco"), "coal", version("coal"))
ways = (from_text, from_binary, from_model, from_spec, from_coal)
found = [way() for way in ways]
for way, (low, high) in zip(ways, found, strict=True):
    print(f"{way.__name__}: height {low:g} m at y = {PLACES[0]}, {high:g} m at y = {PLACES[1]}")
if not np.allclose(found, ([0, 0.9], [0.9, 0], [0.9, 0], [0.9, 0], [0, 0.9]), atol=0.01):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# mujoco 4.0.0 coal 3.0.3
# from_text: height 0 m at y = -0.9, 0.9 m at y = 0.9
# from_binary: height 0.9 m at y = -0.9, 0 m at y = 0.9
# from_model: height 0.9 m at y = -0.9, 0 m at y = 0.9
# from_spec: height 0.9 m at y = -0.9, 0 m at y = 0.9
# from_coal: height 0 m at y = -0.9, 0.9 m at y = 0.9
