"""The picture without distortion that OpenGL draws for a camera, and how the lens bends it."""

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.sensors.camera import CameraSensor
from arm_node.frozen import frozen

MARGIN = 2
"""Pixels around the rays that are needed: between two, and a next one to tell an edge."""
SMOOTH = 1e-3
"""Largest bend of the inverse depth from pixel to pixel, relative to it, on one surface."""
ACROSS = np.array([[1.0, -2.0, 1.0]], np.float32)
"""The second difference along a row."""


@frozen
class PinholeView:
    """A perspective projection, in pixels.

    Attributes:
        width: width of the picture.
        height: height of the picture.
        fx: horizontal focal length.
        fy: vertical focal length.
        cx: column of the principal point, from the picture's left edge.
        cy: row of the principal point, from its upper edge.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float

    @classmethod
    def of(cls, sensor: CameraSensor) -> "PinholeView":
        """Return the smallest view, at the sensor's focal length, that has all that it sees."""
        lens = sensor.lens
        if lens.is_pinhole:
            return cls(sensor.width, sensor.height, lens.fx, lens.fy, lens.cx, lens.cy)
        # The inside of a picture stays inside its outline, because the lens is one-to-one.
        x, y = lens.outline(sensor.width, sensor.height).T
        left, right = _span(lens.fx * x)
        top, bottom = _span(lens.fy * y)
        return cls(right - left, bottom - top, lens.fx, lens.fy, -float(left), -float(top))


def _span(pixels: NDArray[np.float64]) -> tuple[int, int]:
    return math.floor(pixels.min()) - MARGIN, math.ceil(pixels.max()) + MARGIN


def drawn_size(sensors: Iterable[CameraSensor]) -> tuple[int, int]:
    """Return the width and the height in pixels that pictures of all these cameras fit in."""
    views = [PinholeView.of(sensor) for sensor in sensors]
    return max(view.width for view in views), max(view.height for view in views)


class LensTable:
    """Takes a sensor's pixels from a view; the table is made once.

    Args:
        sensor: the camera, which is not a pinhole.
        view: its view; row 0 of the drawn arrays is the bottom one, as OpenGL has it.
    """

    def __init__(self, sensor: CameraSensor, view: PinholeView) -> None:
        rays = sensor.lens.rays(sensor.width, sensor.height)
        # The centre of OpenCV's first pixel is at 0.
        self._columns = (view.fx * rays[..., 0] + view.cx - 0.5).astype(np.float32)
        self._rows = (view.height - 0.5 - view.cy - view.fy * rays[..., 1]).astype(np.float32)

    def bend_colours(self, drawn: NDArray[np.uint8], picture: NDArray[np.uint8]) -> None:
        """Interpolate the colours (height, width, 3) of a drawn view into the sensor's picture."""
        import cv2  # Only here, because it costs 0.1 s and 40 MB.

        cv2.remap(drawn, self._columns, self._rows, cv2.INTER_LINEAR, dst=picture)

    def bend_depth(self, drawn: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the inverse depth at the sensor's pixels.

        It is interpolated on a surface, where it is linear if the surface is flat. At an edge it is
        that of the nearest pixel, because a mean of two surfaces would be on neither.
        """
        import cv2

        place = self._columns, self._rows
        bends = (cv2.filter2D(drawn, -1, second) for second in (ACROSS, ACROSS.T))
        edges = np.maximum(*map(np.abs, bends)) > SMOOTH * drawn
        beside_edge = cv2.remap(edges.astype(np.float32), *place, cv2.INTER_LINEAR) > 0
        nearest = cv2.remap(drawn, *place, cv2.INTER_NEAREST)
        return np.where(beside_edge, nearest, cv2.remap(drawn, *place, cv2.INTER_LINEAR))
