#!/usr/bin/env bash
# pin 4.1.0 (Pinocchio): buildModelFromMJCF() takes the mass of a body from other shapes than MuJoCo does.
#
# A body without <inertial> weighs what its shapes weigh. In MuJoCo all of them count, those without
# contacts as well, unless <compiler inertiagrouprange> leaves out a group. A good guess is the same
# rule, as density, mass and the inertia of each shape are read right. Pinocchio leaves out what has
# contype="0" conaffinity="0", and does not look at inertiagrouprange. So of a link of 1 kg with a cover
# of 3 kg that touches nothing the cover is lost, and a shape for contacts, which the file keeps out of
# the mass, is added: 1 for 4 kg, and 4 for 1 kg, without a word.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'pin==4.1.0' 'mujoco==4.0.0'

"$folder/venv/bin/python" - "$folder/link.xml" <<'PYTHON'
import sys
from importlib.metadata import version

import mujoco
import pinocchio

path = sys.argv[1]
LINK = """<mujoco><compiler {compiler}/><worldbody><body name="link"><joint axis="0 0 1"/>
  <geom type="box" size="0.05 0.05 0.05" mass="1"/>
  <geom type="box" size="0.05 0.05 0.05" mass="3" {shape}/></body></worldbody></mujoco>"""
GROUPS = 'inertiagrouprange="0 1"'
CASES = {
    "all shapes": ("", ""),
    "a cover without contacts": ("", 'contype="0" conaffinity="0"'),
    "a group that is left out": (GROUPS, 'group="3"'),
}


def masses(compiler: str, shape: str) -> tuple[float, float]:
    """Return the link's mass in Pinocchio and in MuJoCo, in kg."""
    with open(path, "w") as file:
        file.write(LINK.format(compiler=compiler, shape=shape))
    built = pinocchio.buildModelFromMJCF(path)
    model = built if isinstance(built, pinocchio.Model) else built[0]
    return model.inertias[1].mass, float(mujoco.MjModel.from_xml_path(path).body_mass[1])


print("pin", version("pin"), "MuJoCo", version("mujoco"))
found = {name: masses(*case) for name, case in CASES.items()}
for name, (pinned, simulated) in found.items():
    print(f"{name}: Pinocchio {pinned:g} kg, MuJoCo {simulated:g} kg")
if list(found.values()) != [(4, 4), (1, 4), (4, 1)]:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# pin 4.1.0 MuJoCo 4.0.0
# all shapes: Pinocchio 4 kg, MuJoCo 4 kg
# a cover without contacts: Pinocchio 1 kg, MuJoCo 4 kg
# a group that is left out: Pinocchio 4 kg, MuJoCo 1 kg
