#!/usr/bin/env bash
# robodk 6.0.2: Pose_2_Nachi() and Nachi_2_Pose() are not each other's inverse.
#
# robodk.robomath has a pair of functions for the targets of each controller, and a good guess is that a
# pose which goes out by one and in by the other is the same, as it is for Fanuc, Motoman, KUKA, Staubli,
# Adept, Comau, Techman and UR. For Nachi the three angles leave as yaw, pitch, roll and are taken as roll,
# pitch, yaw: a tool that looks straight down comes back looking up, and 0.1 0.5 0.9 rad are 78 degrees off.
# Both call the numbers XYZRPW. Turning about y alone hides it.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'robodk==6.0.2' 'numpy==2.4.6'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
from robodk import robomath

TURNS = {"roll 180 (down)": (np.pi, 0, 0), "0.1 0.5 0.9 rad": (0.1, 0.5, 0.9), "pitch 0.5": (0, 0.5, 0)}
KINDS = ("Fanuc", "Motoman", "KUKA", "Staubli", "Adept", "Comau", "Techman", "UR", "Nachi")


def off_deg(kind: str, rpy: tuple[float, float, float]) -> float:
    """Return the angle between a pose and what comes back."""
    pose = robomath.transl(100, 200, 300) * robomath.rotz(rpy[2]) * robomath.roty(rpy[1]) * robomath.rotx(rpy[0])
    numbers = getattr(robomath, f"Pose_2_{kind}")(pose)
    back = getattr(robomath, f"{kind}_2_Pose")(numbers)
    one, other = (np.array(p.Rows())[:3, :3] for p in (pose, back))
    return float(np.degrees(np.arccos(np.clip((np.trace(one.T @ other) - 1) / 2, -1, 1))))


print("robodk", version("robodk"))
found = {kind: [round(off_deg(kind, rpy), 2) for rpy in TURNS.values()] for kind in KINDS}
print("off by degrees, for", ", ".join(TURNS))
for kind, off in found.items():
    print(f"{kind}: {off}")
nachi = found.pop("Nachi")
if not (np.allclose(nachi, [180, 78.27, 0], atol=0.02) and np.abs(list(found.values())).max() < 0.02):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# robodk 6.0.2
# off by degrees, for roll 180 (down), 0.1 0.5 0.9 rad, pitch 0.5
# Fanuc: [0.0, 0.0, 0.0]
# Motoman: [0.0, 0.0, 0.0]
# KUKA: [0.0, 0.0, 0.0]
# Staubli: [0.0, 0.0, 0.0]
# Adept: [0.0, 0.0, 0.0]
# Comau: [0.0, 0.0, 0.0]
# Techman: [0.0, 0.0, 0.0]
# UR: [0.0, 0.0, 0.0]
# Nachi: [180.0, 78.27, 0.0]
