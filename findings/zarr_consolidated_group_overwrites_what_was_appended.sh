#!/usr/bin/env bash
# zarr 3.1.6: appending to an array of a consolidated group, in one opening after the other, overwrites.
#
# consolidate_metadata() puts the metadata of all arrays into one file, and is recommended for datasets
# that are read often. A good guess is that a group which is opened for writing, mode="a", knows the
# length of its arrays, so that each run can append an episode. The copy is read and not renewed:
# append() writes the new length into the array's own file alone. Who opens the group sees the old
# length and not what was appended, and the next one to append starts from the old length too, over the
# rows of the one before: of the episodes 2, 3 and 4 only 4 is left. Nothing is said.
# use_consolidated=False, or a new consolidate_metadata() after each write, makes it right. The same
# appends without consolidation all stay.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'zarr==3.1.6' 'numpy==2.4.6'

"$folder/venv/bin/python" -W ignore - "$folder" <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
import zarr

folder = sys.argv[1]


def recorded(name: str, zarr_format: int, consolidated: bool, **how: bool) -> tuple[list, list]:
    """Return what the group and the array itself show after the episodes 2, 3 and 4 were appended to 1."""
    path = f"{folder}/{name}-{zarr_format}.zarr"
    group = zarr.open_group(path, mode="w", zarr_format=zarr_format)
    group.create_array("q", shape=(2,), chunks=(2,), dtype="i4")[:] = 1
    if consolidated:
        zarr.consolidate_metadata(path)
    for episode in (2, 3, 4):
        zarr.open_group(path, mode="a", **how)["q"].append(np.full(2, episode, "i4"))
    seen = zarr.open_group(path, mode="r")["q"][:]
    return seen.tolist(), zarr.open_array(f"{path}/q", mode="r")[:].tolist()


print("zarr", version("zarr"))
right = []
for zarr_format in (2, 3):
    plain = recorded("plain", zarr_format, consolidated=False)
    kept = recorded("kept", zarr_format, consolidated=True, use_consolidated=False)
    lost = recorded("lost", zarr_format, consolidated=True)
    print(f"format {zarr_format}, not consolidated: group {plain[0]}, array {plain[1]}")
    print(f"format {zarr_format}, opened with use_consolidated=False: group {kept[0]}, array {kept[1]}")
    print(f"format {zarr_format}, consolidated: group {lost[0]}, array {lost[1]}")
    whole = [1, 1, 2, 2, 3, 3, 4, 4]
    right += [plain == (whole, whole), kept == ([1, 1], whole), lost == ([1, 1], [1, 1, 4, 4])]
if not all(right):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# zarr 3.1.6
# format 2, not consolidated: group [1, 1, 2, 2, 3, 3, 4, 4], array [1, 1, 2, 2, 3, 3, 4, 4]
# format 2, opened with use_consolidated=False: group [1, 1], array [1, 1, 2, 2, 3, 3, 4, 4]
# format 2, consolidated: group [1, 1], array [1, 1, 4, 4]
# format 3, not consolidated: group [1, 1, 2, 2, 3, 3, 4, 4], array [1, 1, 2, 2, 3, 3, 4, 4]
# format 3, opened with use_consolidated=False: group [1, 1], array [1, 1, 2, 2, 3, 3, 4, 4]
# format 3, consolidated: group [1, 1], array [1, 1, 4, 4]
