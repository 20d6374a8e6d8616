#!/usr/bin/env bash
# small_gicp 1.0.1: voxelgrid_sampling() makes one point of all points that are a million voxels from the origin.
#
# Coordinates are doubles, and a good guess is that a cloud in map coordinates (UTM: hundreds of thousands of
# metres) is thinned like the same cloud near the origin. A voxel's index has 21 bits for each axis. Beyond them
# the points are not left out and nothing is raised: they all get the same key and are averaged into one
# point, here 20,000 points over 50 m (with two threads into 20). preprocess_points() and align() thin in this
# way, too, so that a registration of two such clouds compares two single points. With voxels of 1 mm the limit is
# at 1049 m, with 0.25 m at 262 km. Standard error has a line for each point; a program's log has none. Take a
# common origin off before.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'small_gicp==1.0.1' 'numpy==2.4.6'

"$folder/venv/bin/python" - 2> "$folder/said" <<'PYTHON' || { tail -n 3 "$folder/said"; exit 1; }
import sys
from importlib.metadata import version

import numpy as np
import small_gicp

points = np.random.default_rng(0).uniform(0, 50, size=(20000, 3))
print("small_gicp", version("small_gicp"))
found = []
for size, far in ((0.25, 0.0), (0.25, 262_000.0), (0.25, 262_200.0), (0.001, 950.0), (0.001, 1100.0)):
    counts = [
        small_gicp.voxelgrid_sampling(points + (far, 0, 0), size, num_threads=threads).size() for threads in (1, 2)
    ]
    found.append(counts[0])
    print(f"voxels of {size} m, x from {far:.0f} m on: {counts[0]} points, {counts[1]} with two threads")
if not (found[0] > 19000 and found[1] > 19000 and found[2] == 1 and found[3] > 19000 and found[4] == 1):
    sys.exit("the behaviour has changed")
PYTHON
echo "standard error: $(head -n 1 "$folder/said")"
# Output seen:
# small_gicp 1.0.1
# voxels of 0.25 m, x from 0 m on: 19975 points, 19975 with two threads
# voxels of 0.25 m, x from 262000 m on: 19975 points, 19975 with two threads
# voxels of 0.25 m, x from 262200 m on: 1 points, 20 with two threads
# voxels of 0.001 m, x from 950 m on: 20000 points, 20000 with two threads
# voxels of 0.001 m, x from 1100 m on: 1 points, 20 with two threads
# standard error: warning: voxel coord is out of range!!
