#!/usr/bin/env bash
# point-cloud-utils 0.34.0: a query of one point gets another answer than the same point among two.
#
# A good guess is that each row of a query is answered by itself. An array of shape (1, 3) lies in memory by rows
# and by columns at once. The library takes it to lie by columns and then reads the other array, the mesh or the
# cloud, by columns too, although it lies by rows: its coordinates are mixed up. No error comes, as one does for a
# longer query by columns. So a point 0.25 m inside a cube is 0.18 m outside, a ray that hits the cube after
# 4.5 m hits after 0.5 m, and the nearest neighbour in a cloud is another one and further off. Who asks for one
# tool point or one grasp at a time meets this, a test on many points does not. Ask for the point twice, or
# pass the mesh as np.asfortranarray().
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'point-cloud-utils==0.34.0' 'numpy==2.4.6' 'scipy==1.16.3'

"$folder/venv/bin/python" - <<'PYTHON'
import itertools
import sys
from importlib.metadata import version

import numpy as np
import point_cloud_utils

# A cube of 1 m about the origin; seen from outside, the corners of a face run counter-clockwise.
CORNERS = np.array(list(itertools.product((-0.5, 0.5), repeat=3)))
FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
    + [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)
CLOUD = np.random.default_rng(0).normal(size=(50, 3))
INSIDE, ABOVE, DOWN = [0.25, 0.0, 0.0], [0.1, 0.2, 5.0], [0.0, 0.0, -1.0]


def answers(count: int) -> dict[str, float]:
    """Return the answers for the first of a number of equal queries."""

    def rows(row: list[float]) -> np.ndarray:
        return np.array([row] * count)

    def first(values: np.ndarray) -> float:
        return float(np.ravel(values)[0])

    turned = np.asfortranarray(CORNERS), np.asfortranarray(FACES)
    distances = point_cloud_utils.signed_distance_to_mesh
    found = {
        "signed_distance_to_mesh": first(distances(rows(INSIDE), CORNERS, FACES)[0]),
        "closest_points_on_mesh": first(point_cloud_utils.closest_points_on_mesh(rows(INSIDE), CORNERS, FACES)[0]),
        "ray_mesh_intersection": first(
            point_cloud_utils.ray_mesh_intersection(CORNERS, FACES, rows(ABOVE), rows(DOWN))[2]
        ),
        "k_nearest_neighbors": first(point_cloud_utils.k_nearest_neighbors(rows(INSIDE), CLOUD, 1)[0]),
    }
    if count == 1:
        found["signed_distance_to_mesh, np.asfortranarray"] = first(distances(rows(INSIDE), *turned)[0])
    return found


print("point-cloud-utils", version("point-cloud-utils"))
true = {
    "signed_distance_to_mesh": -0.25,
    "closest_points_on_mesh": 0.25,
    "ray_mesh_intersection": 4.5,
    "k_nearest_neighbors": float(np.linalg.norm(CLOUD - INSIDE, axis=1).min()),
}
one, two = answers(1), answers(2)
right = np.isclose(one.pop("signed_distance_to_mesh, np.asfortranarray"), -0.25)
for name, value in true.items():
    print(f"{name}: {one[name]:.3f} m alone, {two[name]:.3f} m as one of two; true {value:.3f} m")
    right &= np.isclose(two[name], value, atol=1e-3) and not np.isclose(one[name], value, atol=0.05)
if not right:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# point-cloud-utils 0.34.0
# signed_distance_to_mesh: 0.177 m alone, -0.250 m as one of two; true -0.250 m
# closest_points_on_mesh: 0.177 m alone, 0.250 m as one of two; true 0.250 m
# ray_mesh_intersection: 0.500 m alone, 4.500 m as one of two; true 4.500 m
# k_nearest_neighbors: 0.406 m alone, 0.258 m as one of two; true 0.258 m
