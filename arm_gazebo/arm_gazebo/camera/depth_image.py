"""Convert rendered depth to a depth camera's output: REP 117's limits, and point clouds."""

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.sensors.camera import CameraSensor

CHANNELS = 4
"""Values of a point: x, y, z, and its colour."""


def mark_limits(depth: NDArray[np.float32], sensor: CameraSensor) -> None:
    """Mark distances in m in place, as REP 117 requires: too near becomes -inf, too far inf."""
    depth[depth < sensor.near] = -np.inf
    depth[depth > sensor.far] = np.inf


class PointGrid:
    """Converts distances to points. One thread."""

    def __init__(self, sensor: CameraSensor) -> None:
        rays = np.ones((sensor.height, sensor.width, 3))
        rays[..., :2] = sensor.lens.rays(sensor.width, sensor.height)
        optics = np.reshape(sensor.optics_in_frame, (3, 4))
        self._rays = np.moveaxis(rays @ optics[:, :3].T, -1, 0).astype(np.float32, order="C")
        self._origin = optics[:, 3].astype(np.float32)

    def fill(
        self,
        points: NDArray[np.float32],
        depth: NDArray[np.float32],
        picture: NDArray[np.uint8] | None,
    ) -> None:
        """Write the points of a view.

        Args:
            points: (height, width, 4), overwritten: x, y, z in the camera's frame in m, all NaN
                where the depth is not finite, and the colour in the bits of a float as PCL packs
                it.
            depth: (height, width) in m.
            picture: (height, width, 3) RGB; None for points without colour.
        """
        known = np.where(np.isfinite(depth), depth, np.float32(np.nan))
        # Axis by axis, because NumPy is twenty times slower over the three values of each point.
        for axis, (rays, origin) in enumerate(zip(self._rays, self._origin, strict=True)):
            np.multiply(rays, known, out=points[..., axis])
            points[..., axis] += origin
        colours = points.view(np.uint8).reshape(*depth.shape, 4 * CHANNELS)[..., 12:]
        colours[:] = 0
        if picture is not None:
            # Little-endian 0x00RRGGBB.
            colours[..., :3] = picture[..., ::-1]
