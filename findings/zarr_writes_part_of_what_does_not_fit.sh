#!/usr/bin/env bash
# zarr 3.1.6: an assignment whose rows do not fit is cut to what fits, without an error.
#
# A good guess, as "an array that works like NumPy's" is what Zarr offers and what h5py does, is an error:
# a[2:7] = five rows into an array of four is refused. Zarr writes the two rows that have a place and
# drops three; a[4:6] behind the end writes nothing, and a[0:2] takes two of five rows or columns. So an
# episode that is longer than what was reserved for it loses its end, and one that is written behind the
# end is lost whole, silently. Too few rows are refused, but only as far as a whole chunk is without.
# NumPy's rule of broadcasting says that a dimension of 5 fits none of 2.
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
ROWS = np.arange(1, 11).reshape(5, 2)
# Where to write, what is written, and what Zarr's array of 4 rows of 2 holds afterwards.
CASES = (
    (slice(2, 4), ROWS[:2], [0, 0, 0, 0, 1, 2, 3, 4]),
    (slice(2, 7), ROWS, [0, 0, 0, 0, 1, 2, 3, 4]),
    (slice(4, 6), ROWS[:2], [0, 0, 0, 0, 0, 0, 0, 0]),
    (slice(0, 2), ROWS, [1, 2, 3, 4, 0, 0, 0, 0]),
    (slice(0, 2), np.ones((2, 3)), [1, 1, 1, 1, 0, 0, 0, 0]),
    (slice(0, 4), ROWS[:2], None),
)


def written(array: object, place: slice, values: np.ndarray) -> list[int] | None:
    """Return what the array holds after the assignment, or None if that was refused."""
    try:
        array[place] = values
    except (TypeError, ValueError):
        return None
    return [int(value) for value in array[:].ravel()]


print("zarr", version("zarr"), "h5py", version("h5py"), "NumPy", version("numpy"))
right = []
with h5py.File(f"{folder}/rows.h5", "w") as file:
    for index, (place, values, expected) in enumerate(CASES):
        stored = zarr.create_array(f"{folder}/{index}.zarr", shape=(4, 2), chunks=(2, 2), dtype="f4")
        other = file.create_dataset(str(index), shape=(4, 2), chunks=(2, 2), dtype="f4")
        found = [written(array, place, values) for array in (stored, other, np.zeros((4, 2)))]
        print(f"[{place.start}:{place.stop}] = {values.shape}: zarr", found[0], "h5py", found[1], "NumPy", found[2])
        right.append(found[0] == expected and (found[1:] == [None, None] or (index == 0 and found[1] == found[2])))
if not all(right):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# zarr 3.1.6 h5py 3.16.0 NumPy 2.4.6
# [2:4] = (2, 2): zarr [0, 0, 0, 0, 1, 2, 3, 4] h5py [0, 0, 0, 0, 1, 2, 3, 4] NumPy [0, 0, 0, 0, 1, 2, 3, 4]
# [2:7] = (5, 2): zarr [0, 0, 0, 0, 1, 2, 3, 4] h5py None NumPy None
# [4:6] = (2, 2): zarr [0, 0, 0, 0, 0, 0, 0, 0] h5py None NumPy None
# [0:2] = (5, 2): zarr [1, 2, 3, 4, 0, 0, 0, 0] h5py None NumPy None
# [0:2] = (2, 3): zarr [1, 1, 1, 1, 0, 0, 0, 0] h5py None NumPy None
# [0:4] = (2, 2): zarr None h5py None NumPy None
