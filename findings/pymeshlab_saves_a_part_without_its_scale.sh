#!/usr/bin/env bash
# pymeshlab 2025.7.post1: a glTF part of 2 mm is converted into an STL part of 2 m.
#
# A glTF file gives each mesh a node with a pose and a scale, often 0.001 for a part drawn in mm. A good
# guess is that load_new_mesh() and save_current_mesh() keep both, all the more as get_geometric_measures()
# between the two has the right volume and centre. The node's matrix is kept beside the vertices, the
# measures use it, and none of the formats STL, PLY, OBJ, OFF and DAE is written with it: the part becomes
# 1000 times larger and goes to the origin, without a message. apply_matrix_freeze() before saving writes
# the pose into the vertices.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'pymeshlab==2025.7.post1' 'numpy==2.4.6'

"$folder/venv/bin/python" - "$folder" <<'PYTHON'
import base64
import json
import sys
from importlib.metadata import version
from itertools import product
from pathlib import Path

import numpy as np
import pymeshlab

folder = Path(sys.argv[1])
CORNERS = np.array(list(product((-1, 1), repeat=3)), "<f4")
TRIANGLES = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
TRIANGLES += [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
content = CORNERS.tobytes() + np.array(TRIANGLES, "<u2").tobytes()
GLTF = {
    "asset": {"version": "2.0"},
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "scale": [0.001, 0.001, 0.001], "translation": [0.5, 0, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "buffers": [
        {
            "byteLength": len(content),
            "uri": "data:application/octet-stream;base64," + base64.b64encode(content).decode(),
        }
    ],
    "bufferViews": [
        {"buffer": 0, "byteOffset": 0, "byteLength": CORNERS.nbytes},
        {"buffer": 0, "byteOffset": CORNERS.nbytes, "byteLength": 72},
    ],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [-1] * 3, "max": [1] * 3},
        {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"},
    ],
}
(folder / "part.gltf").write_text(json.dumps(GLTF))


def measured(meshes: pymeshlab.MeshSet) -> tuple[float, float]:
    """Return the size of a cube, from its volume, and its place along x, in m."""
    measures = meshes.get_geometric_measures()
    return float(np.cbrt(measures["mesh_volume"])), float(measures["center_of_mass"][0])


def loaded(name: str) -> pymeshlab.MeshSet:
    """Return a file's mesh."""
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(folder / name))
    return meshes


print("pymeshlab", version("pymeshlab"))
part = loaded("part.gltf")
found = {"the loaded part": measured(part)}
for ending in ("stl", "ply", "obj", "off", "dae"):
    part.save_current_mesh(str(folder / f"saved.{ending}"))
    found[ending] = measured(loaded(f"saved.{ending}"))
part.apply_matrix_freeze()
part.save_current_mesh(str(folder / "frozen.stl"))
found["stl, frozen before"] = measured(loaded("frozen.stl"))
for name, (size, place) in found.items():
    print(f"{name}: {size:.4g} m wide at x = {place:.4g} m")
right = (0.002, 0.5)
for name, one in found.items():
    if not np.allclose(one, right if name in ("the loaded part", "stl, frozen before") else (2, 0), atol=1e-6):
        sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# pymeshlab 2025.7.post1
# the loaded part: 0.002 m wide at x = 0.5 m
# stl: 2 m wide at x = 0 m
# ply: 2 m wide at x = 0 m
# obj: 2 m wide at x = 0 m
# off: 2 m wide at x = 0 m
# dae: 2 m wide at x = 0 m
# stl, frozen before: 0.002 m wide at x = 0.5 m
