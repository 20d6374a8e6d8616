"""Point clouds as arrays, and clouds that are none."""

from array import array

import numpy as np
import pytest
from sensor_msgs.msg import PointCloud2, PointField

from arm_planning.errors import PerceptionError
from arm_planning.ros.point_clouds import points_of

POINTS = np.arange(24, dtype=np.float32).reshape(2, 4, 3)


def cloud(order: str = "<", **changes):
    """Return the points with a colour behind each, and four bytes at the end of a row."""
    packed = np.zeros((2, 4 * 16 + 4), np.uint8)
    for row in range(2):
        for column in range(4):
            values = POINTS[row, column].astype(f"{order}f4").tobytes()
            packed[row, 16 * column : 16 * column + 12] = np.frombuffer(values, np.uint8)
    message = PointCloud2(height=2, width=4, point_step=16, row_step=68, is_bigendian=order == ">")
    message.fields = [
        PointField(name=name, offset=4 * index, datatype=PointField.FLOAT32, count=1)
        for index, name in enumerate(("x", "y", "z", "rgb"))
    ]
    message.data = array("B", packed.tobytes())
    for name, value in changes.items():
        setattr(message, name, value)
    return message


@pytest.mark.parametrize("order", ["<", ">"])
def test_points_are_read_in_rows_and_columns(order):
    np.testing.assert_array_equal(points_of(cloud(order)), POINTS)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"height": 1, "width": 8}, "not organised"),
        ({"fields": []}, "it has none"),
        ({"fields": [PointField(name="x", datatype=PointField.FLOAT64)]}, "it has x"),
        ({"row_step": 60}, "broken"),
        ({"point_step": 8}, "broken"),
        ({"data": array("B", bytes(100))}, "broken"),
        ({"height": 3}, "broken"),
    ],
)
def test_a_cloud_that_cannot_be_used_is_told_why(changes, says):
    with pytest.raises(PerceptionError, match=says):
        points_of(cloud(**changes))
