#!/usr/bin/env bash
# numpy-stl 4.1.1: Mesh.from_file() of a text STL with several solids reads the first and leaves out the rest.
#
# A text STL may hold one solid after the other; CAD programs write one for each body of a part. A good
# guess, from trimesh, meshio, PyMeshLab, VTK (pyvista) and assimp (coal), is that the file is one mesh of
# all of them, or that a reader which takes one only says so. from_file() returns the first solid, with its
# volume and centre of mass, and no warning: of a gripper exported as a palm and two fingers the
# inertia is that of the palm. from_multi_file() gives all three, one by one.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'numpy-stl==4.1.1' 'trimesh==5.2.0' 'meshio==5.3.5' 'coal==3.0.3' \
  'pymeshlab==2025.7.post1' 'pyvista==0.49.1' 'numpy==2.4.6' 'scipy==1.16.3'

"$folder/venv/bin/python" -W ignore - "$folder/gripper.stl" <<'PYTHON'
import sys
import warnings
from importlib.metadata import version

import coal
import meshio
import numpy as np
import pymeshlab
import pyvista
import trimesh
from stl.mesh import Mesh

path = sys.argv[1]


def solid(name: str, size: tuple[float, float, float], x: float) -> str:
    """Return a box as text."""
    box = trimesh.creation.box(size)
    box.apply_translation([x, 0, 0])
    lines = [f"solid {name}"]
    for normal, corners in zip(box.face_normals, box.triangles):
        lines += ["facet normal {} {} {}".format(*normal), "outer loop"]
        lines += ["vertex {} {} {}".format(*corner) for corner in corners]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, f"endsolid {name}", ""])


with open(path, "w") as file:
    file.write(solid("palm", (4, 1, 1), 0) + solid("left", (1, 1, 3), -3) + solid("right", (1, 1, 3), 3))
with warnings.catch_warnings():
    warnings.simplefilter("error")
    first = Mesh.from_file(path)
meshes = pymeshlab.MeshSet()
meshes.load_new_mesh(path)
found = {
    "numpy-stl from_file": len(first.vectors),
    "numpy-stl from_multi_file": sum(len(part.vectors) for part in Mesh.from_multi_file(path)),
    "trimesh": len(trimesh.load_mesh(path).faces),
    "meshio": sum(len(block.data) for block in meshio.read(path).cells),
    "coal": coal.MeshLoader().load(path, np.ones(3)).num_tris,
    "PyMeshLab": sum(mesh.face_number() for mesh in meshes),
    "pyvista": pyvista.read(path).n_cells,
}
print("numpy-stl", version("numpy-stl"), "trimesh", version("trimesh"), "meshio", version("meshio"))
for name, triangles in found.items():
    print(f"{name}: {triangles} triangles of 36")
volume = first.get_mass_properties()[0]
print(f"numpy-stl: volume {volume:.1f} of {trimesh.load_mesh(path).volume:.1f}")
if list(found.values()) != [12] + [36] * 6 or not np.isclose(volume, 4):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# numpy-stl 4.1.1 trimesh 5.2.0 meshio 5.3.5
# numpy-stl from_file: 12 triangles of 36
# numpy-stl from_multi_file: 36 triangles of 36
# trimesh: 36 triangles of 36
# meshio: 36 triangles of 36
# coal: 36 triangles of 36
# PyMeshLab: 36 triangles of 36
# pyvista: 36 triangles of 36
# numpy-stl: volume 4.0 of 10.0
