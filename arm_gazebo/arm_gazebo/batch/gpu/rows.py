"""Rows of arrays on a device, one for each copy: write some of them, and read a column."""

import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.kernel
def write_rows(
    row: wp.array[wp.float32], rows: wp.array[wp.int32], array: wp.array2d[wp.float32]
) -> None:
    """Write one row to several rows of an array."""
    each, column = wp.tid()
    array[rows[each], column] = row[column]


@wp.kernel
def read_column(array: wp.array2d[wp.vec3], column: wp.int32, result: wp.array[wp.vec3]) -> None:
    """Read a column of vectors."""
    copy = wp.tid()
    result[copy] = array[copy, column]
