#!/usr/bin/env bash
# trimesh 5.2.0: the moment_inertia of a Cylinder or a Sphere primitive does not know its density.
#
# A good guess is that density works for a primitive as for any mesh: mass and moment_inertia follow,
# as they do for primitives.Box, primitives.Capsule and creation.cylinder(). For the two round ones the
# mass follows and moment_inertia stays that of 1 kg/m3: an aluminium roller of 42 kg has the moment of
# inertia of one of 16 g. mass_properties of the same object has the right tensor. A link whose
# mass and moment_inertia are written into a URDF or a model turns 2700 times too easily.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'trimesh==5.2.0' 'numpy==2.4.6' 'scipy==1.16.3'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
from trimesh import creation, primitives

DENSITY = 2700.0
RADIUS, HEIGHT = 0.1, 0.5
DISC = np.pi * RADIUS**2 * HEIGHT * DENSITY * RADIUS**2 / 2
BALL = 4 / 3 * np.pi * RADIUS**3 * DENSITY * 0.4 * RADIUS**2
BOX = 0.1 * 0.2 * 0.3 * DENSITY * (0.1**2 + 0.2**2) / 12
BODIES = {
    "primitives.Cylinder": (primitives.Cylinder(radius=RADIUS, height=HEIGHT), DISC),
    "primitives.Sphere": (primitives.Sphere(radius=RADIUS), BALL),
    "primitives.Box": (primitives.Box((0.1, 0.2, 0.3)), BOX),
    "creation.cylinder": (creation.cylinder(RADIUS, HEIGHT, sections=256), DISC),
}

print("trimesh", version("trimesh"))
ratios = []
for name, (body, true) in BODIES.items():
    body.density = DENSITY
    direct, listed = body.moment_inertia[2, 2], body.mass_properties["inertia"][2, 2]
    ratios.append((direct / true, listed / true))
    print(f"{name}: {body.mass:.2f} kg, Izz {direct:.6f}, in mass_properties {listed:.6f}, true {true:.6f} kg m2")
if not np.allclose(ratios, [(1 / DENSITY, 1)] * 2 + [(1, 1)] * 2, rtol=0.02, atol=1e-6):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# trimesh 5.2.0
# primitives.Cylinder: 42.14 kg, Izz 0.000079, in mass_properties 0.209348, true 0.212058 kg m2
# primitives.Sphere: 11.21 kg, Izz 0.000017, in mass_properties 0.044592, true 0.045239 kg m2
# primitives.Box: 16.20 kg, Izz 0.067500, in mass_properties 0.067500, true 0.067500 kg m2
# creation.cylinder: 42.41 kg, Izz 0.212015, in mass_properties 0.212015, true 0.212058 kg m2
