"""Depth cameras' point clouds as arrays."""

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import PointCloud2, PointField

from arm_planning.errors import PerceptionError

AXES = ("x", "y", "z")


def points_of(message: PointCloud2) -> NDArray[np.float32]:
    """Return the points of a depth camera's cloud, (height, width, 3), in m.

    Raises:
        PerceptionError: it is not organised in the rows of a picture, or is broken.
    """
    if message.height < 2 or message.width < 2:
        raise PerceptionError(
            f"the point cloud is not organised in rows and columns as a picture: it has "
            f"{message.height} rows of {message.width} points"
        )
    offsets = {
        field.name: field.offset
        for field in message.fields
        if field.name in AXES and field.datatype == PointField.FLOAT32
    }
    if len(offsets) < len(AXES):
        names = ", ".join(field.name for field in message.fields) or "none"
        raise PerceptionError(
            f"the point cloud lacks fields x, y and z of 32-bit numbers; it has {names}"
        )
    steps = (message.row_step, message.point_step)
    needed = message.height * message.row_step
    if (
        max(offsets.values()) + 4 > message.point_step
        or message.width * message.point_step > message.row_step
        or needed > len(message.data)
    ):
        raise PerceptionError(
            f"the point cloud is broken: {message.height} rows of {message.width} points with "
            f"steps of {steps} bytes do not fit into {len(message.data)} bytes"
        )
    kind = np.dtype(np.float32).newbyteorder(">" if message.is_bigendian else "<")
    columns = [
        np.ndarray((message.height, message.width), kind, message.data, offsets[axis], steps)
        for axis in AXES
    ]
    return np.stack(columns, axis=2).astype(np.float32)
