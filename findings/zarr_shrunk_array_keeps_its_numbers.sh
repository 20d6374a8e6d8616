#!/usr/bin/env bash
# zarr 3.1.6: numbers that were cut off by a resize come back when the array grows again.
#
# A good guess is that what lies behind the end is gone, and that new rows have the fill value until they
# are written, as in HDF5. Zarr removes the chunks that are wholly behind the end and leaves the last one
# as it is: a buffer of 10 rows in chunks of 8 that is cut to 5 (a bad episode is dropped) and enlarged to
# 10 has the old rows 6 to 8 in it, and fill values after them. Where a reader tells by the fill value
# what is not recorded yet, half of the dropped episode counts. With chunks that end at the cut, or in
# h5py, the rows are empty. append() is not concerned, as it writes what it adds.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'zarr==3.1.6' 'h5py==3.16.0' 'numpy==2.4.6'

"$folder/venv/bin/python" - "$folder" <<'PYTHON'
import sys
from importlib.metadata import version

import h5py
import numpy as np
import zarr

folder = sys.argv[1]


def shrunk(array: object) -> list[int]:
    """Return what an array of 10 rows holds after it was cut to 5 and enlarged to 10."""
    array[:] = np.arange(1, 11)
    array.resize((5,))
    array.resize((10,))
    return [int(value) for value in array[:]]


def stored(zarr_format: int, chunk: int) -> list[int]:
    """Return the rows of a Zarr array whose fill value is -1."""
    path = f"{folder}/{zarr_format}-{chunk}.zarr"
    how = {"shape": (10,), "chunks": (chunk,), "dtype": "i4", "fill_value": -1}
    return shrunk(zarr.create_array(path, zarr_format=zarr_format, **how))


print("zarr", version("zarr"), "h5py", version("h5py"))
with h5py.File(f"{folder}/rows.h5", "w") as file:
    how = {"shape": (10,), "chunks": (8,), "maxshape": (None,), "dtype": "i4", "fillvalue": -1}
    other = shrunk(file.create_dataset("rows", **how))
found = {(form, chunk): stored(form, chunk) for form in (2, 3) for chunk in (5, 8)}
for (form, chunk), rows in found.items():
    print(f"Zarr format {form}, chunks of {chunk}: {rows}")
print(f"HDF5, chunks of 8: {other}")
empty = [1, 2, 3, 4, 5] + [-1] * 5
if found != {key: [1, 2, 3, 4, 5, 6, 7, 8, -1, -1] if key[1] == 8 else empty for key in found} or other != empty:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# zarr 3.1.6 h5py 3.16.0
# Zarr format 2, chunks of 5: [1, 2, 3, 4, 5, -1, -1, -1, -1, -1]
# Zarr format 2, chunks of 8: [1, 2, 3, 4, 5, 6, 7, 8, -1, -1]
# Zarr format 3, chunks of 5: [1, 2, 3, 4, 5, -1, -1, -1, -1, -1]
# Zarr format 3, chunks of 8: [1, 2, 3, 4, 5, 6, 7, 8, -1, -1]
# HDF5, chunks of 8: [1, 2, 3, 4, 5, -1, -1, -1, -1, -1]
