#!/usr/bin/env bash
# libigl 2.6.3, point-cloud-utils 0.34.0: a signed distance is three times as long where two shells of a mesh overlap.
#
# Robot meshes are often several closed shells that run into each other. A good guess is that a signed distance is
# the distance to the nearest triangle, with a sign that says inside or outside; the sign might be wrong
# somewhere, the length cannot. Both take the sign from the winding number w, as 1 - 2 w, and multiply by it
# without rounding. Where two shells overlap w is 2, so that 0.25 m to the nearest triangle becomes -0.75. Behind a
# hole w is a fraction: the middle of an open box is 0.33 deep in place of 0.5, and 0.5 m outside is 0.53 or 0.47.
# In a mesh that is turned inside out (w = -1) libigl makes a clearance of 1.5 of 0.5 inside. VTK gives
# the plain distance each time. A planner that keeps 5 cm away keeps other distances near such places.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'libigl==2.6.3' 'point-cloud-utils==0.34.0' 'pyvista==0.49.2' 'vtk==9.7.2' \
  'numpy==2.4.6' 'scipy==1.16.3'

"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import sys
from importlib.metadata import version

import igl
import numpy as np
import point_cloud_utils
import pyvista

cube = pyvista.Cube().triangulate()
POINTS = np.array(cube.points, np.float64)
FACES = cube.faces.reshape(-1, 4)[:, 1:].astype(np.int64)
lid = np.isclose(POINTS[FACES].mean(axis=1)[:, 0], 0.5)
# The vertices and faces, and a place with its distance to the nearest triangle.
CASES = {
    "a cube, its middle": (POINTS, FACES, (0, 0, 0), 0.5),
    "two cubes 0.5 m apart, between the two middles": (
        np.vstack([POINTS, POINTS + (0.5, 0, 0)]),
        np.vstack([FACES, FACES + len(POINTS)]),
        (0.25, 0, 0),
        0.25,
    ),
    "the cube turned inside out, its middle": (POINTS, FACES[:, ::-1].copy(), (0, 0, 0), 0.5),
    "the cube without a side, its middle": (POINTS, FACES[~lid], (0, 0, 0), 0.5),
    "the cube without a side, 0.5 m behind it": (POINTS, FACES[~lid], (-1.0, 0, 0), 0.5),
}


def distances(points: np.ndarray, faces: np.ndarray, place: tuple[float, float, float]) -> list[float]:
    """Return the signed distances of libigl, point-cloud-utils and VTK in m."""
    query = np.array([place, place], np.float64)  # two, since point-cloud-utils errs for a single one
    surface = pyvista.PolyData.from_regular_faces(points, faces)
    by_vtk = pyvista.PolyData(query).compute_implicit_distance(surface)["implicit_distance"]
    by_igl = igl.signed_distance(query, points, faces)[0]
    by_utils = point_cloud_utils.signed_distance_to_mesh(query, points, faces)[0]
    return [float(np.ravel(found)[0]) for found in (by_igl, by_utils, by_vtk)]


print(*(f"{name} {version(name)}" for name in ("libigl", "point-cloud-utils", "vtk")))
found = []
for name, (points, faces, place, true) in CASES.items():
    found.append(np.array(distances(points, faces, place)))
    by_igl, by_utils, by_vtk = found[-1]
    print(f"{name}: {true} m from the surface; libigl {by_igl:.3f}, point-cloud-utils {by_utils:.3f}, VTK {by_vtk:.3f}")
expected = [
    (-0.5, -0.5, -0.5),
    (-0.75, -0.75, -0.25),
    (1.5, -0.5, 0.5),
    (-1 / 3, -1 / 3, -0.5),
    (0.532, 0.468, 0.5),
]
if not np.allclose(found, expected, atol=2e-3):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# libigl 2.6.3 point-cloud-utils 0.34.0 vtk 9.7.2
# a cube, its middle: 0.5 m from the surface; libigl -0.500, point-cloud-utils -0.500, VTK -0.500
# two cubes 0.5 m apart, between the two middles: 0.25 m from the surface; libigl -0.750, point-cloud-utils -0.750, VTK -0.250
# the cube turned inside out, its middle: 0.5 m from the surface; libigl 1.500, point-cloud-utils -0.500, VTK 0.500
# the cube without a side, its middle: 0.5 m from the surface; libigl -0.333, point-cloud-utils -0.333, VTK -0.500
# the cube without a side, 0.5 m behind it: 0.5 m from the surface; libigl 0.532, point-cloud-utils 0.468, VTK 0.500
