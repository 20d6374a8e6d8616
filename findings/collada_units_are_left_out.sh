#!/usr/bin/env bash
# trimesh 5.2.0, coal 3.0.3, PyMeshLab 2025.7: a COLLADA file in millimetres or inches is read as metres.
#
# <unit meter="0.001"/> in <asset> is the length that the file's numbers are counted in, and CAD programs
# and Blender write it; RViz scales by it. A good guess is that extents are in metres for every .dae, as
# URDF wants them, so that files with unlike units fit together. trimesh keeps the number in
# mesh.units as the text "0.001 * meters" and leaves the vertices as they are; so do what loads meshes
# through it, such as yourdfpy. coal, and with it Pinocchio's collision models, and PyMeshLab do not tell.
# The bracket of 2 x 3 mm is 2 x 3 m: seen right in RViz, it stands in the way of every plan. A scale in
# the URDF's <mesh> that mends it here spoils it there. trimesh's convert_units("meters") does not
# know its own text.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'trimesh==5.2.0' 'pycollada==0.9.3' 'coal==3.0.3' 'pymeshlab==2025.7.post1' \
  'yourdfpy==0.0.60' 'numpy==2.4.6' 'scipy==1.16.3'

"$folder/venv/bin/python" -W ignore - "$folder" <<'PYTHON'
import sys
from importlib.metadata import version

import coal
import numpy as np
import pymeshlab
import trimesh
import yourdfpy

folder = sys.argv[1]
PART = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="unit" meter="{meter}"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
  <source id="p"><float_array id="a" count="12">0 0 0 1 0 0 0 2 0 0 0 3</float_array>
    <technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
      <param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""
ROBOT = """<robot name="part"><link name="part"><visual><geometry><mesh filename="part.dae"/></geometry></visual>
  </link></robot>"""


def sizes(meter: float) -> tuple[dict[str, np.ndarray], str]:
    """Return the size of the part for each reader, and what trimesh says of its units."""
    path = f"{folder}/part.dae"
    with open(path, "w") as file:
        file.write(PART.format(meter=meter))
    scene = trimesh.load_scene(path)
    mesh = coal.MeshLoader().load(path, np.ones(3))
    mesh.computeLocalAABB()
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(path)
    robot = yourdfpy.URDF.load(f"{folder}/part.urdf")
    box = mesh.aabb_local
    found = {
        "trimesh": scene.extents,
        "yourdfpy": robot.scene.extents,
        "coal": np.ravel([box.width(), box.height(), box.depth()]),
        "PyMeshLab": meshes.current_mesh().vertex_matrix().max(axis=0),
    }
    return found, scene.units


with open(f"{folder}/part.urdf", "w") as file:
    file.write(ROBOT)
print("trimesh", version("trimesh"), "coal", version("coal"), "PyMeshLab", version("pymeshlab"))
right = []
for meter in (1, 0.001, 0.0254):
    found, units = sizes(meter)
    for name, size in found.items():
        print(f"meter={meter}: {name} {np.round(size, 4)}, should be {np.round(np.array([1, 2, 3]) * meter, 4)}")
    print(f"meter={meter}: trimesh's units {units!r}")
    right += [np.allclose(size, (1, 2, 3)) for size in found.values()]
try:
    trimesh.load_scene(f"{folder}/part.dae").convert_units("meters")
    message = ""
except (KeyError, ValueError) as error:
    message = f"{type(error).__name__}: {str(error).splitlines()[0]}"
print("convert_units:", message)
if not all(right):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# trimesh 5.2.0 coal 3.0.3 PyMeshLab 2025.7.post1
# meter=1: trimesh [1. 2. 3.], should be [1 2 3]
# meter=1: yourdfpy [1. 2. 3.], should be [1 2 3]
# meter=1: coal [1. 2. 3.], should be [1 2 3]
# meter=1: PyMeshLab [1. 2. 3.], should be [1 2 3]
# meter=1: trimesh's units 'meters'
# meter=0.001: trimesh [1. 2. 3.], should be [0.001 0.002 0.003]
# meter=0.001: yourdfpy [1. 2. 3.], should be [0.001 0.002 0.003]
# meter=0.001: coal [1. 2. 3.], should be [0.001 0.002 0.003]
# meter=0.001: PyMeshLab [1. 2. 3.], should be [0.001 0.002 0.003]
# meter=0.001: trimesh's units '0.001 * meters'
# meter=0.0254: trimesh [1. 2. 3.], should be [0.0254 0.0508 0.0762]
# meter=0.0254: yourdfpy [1. 2. 3.], should be [0.0254 0.0508 0.0762]
# meter=0.0254: coal [1. 2. 3.], should be [0.0254 0.0508 0.0762]
# meter=0.0254: PyMeshLab [1. 2. 3.], should be [0.0254 0.0508 0.0762]
# meter=0.0254: trimesh's units '0.0254 * meters'
# convert_units: 
