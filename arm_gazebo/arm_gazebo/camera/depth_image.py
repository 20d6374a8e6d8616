"""What a depth camera says of the distances that were drawn: REP 117's limits, and points."""

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.sensors.camera import CameraSensor

CHANNELS = 4
"""Of a point: x, y, z, and its colour."""


def mark_limits(depth: NDArray[np.float32], sensor: CameraSensor) -> None:
    """Say of distances out of range on which side they are, as REP 117 has it; in place.

    Args:
        depth: in m; what is nearer than the near clip becomes -inf, farther than the far one inf.
        sensor: the camera.
    """
    depth[depth < sensor.near] = -np.inf
    depth[depth > sensor.far] = np.inf


class PointGrid:
    """Makes points of distances. One thread."""

    def __init__(self, sensor: CameraSensor) -> None:
        columns = np.arange(sensor.width) + 0.5 - sensor.width / 2
        rows = np.arange(sensor.height) + 0.5 - sensor.height / 2
        rays = np.ones((sensor.height, sensor.width, 3))
        rays[..., 0] = columns / sensor.focal_length
        rays[..., 1] = (rows / sensor.focal_length)[:, np.newaxis]
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
                where the depth is no number, and the colour as PCL packs it into a float's bits.
            depth: (height, width) in m.
            picture: (height, width, 3) RGB; None for points without colour.
        """
        known = np.where(np.isfinite(depth), depth, np.float32(np.nan))
        # Axis by axis: over the three numbers of a point NumPy takes twenty times as long.
        for axis, (rays, origin) in enumerate(zip(self._rays, self._origin, strict=True)):
            np.multiply(rays, known, out=points[..., axis])
            points[..., axis] += origin
        colours = points.view(np.uint8).reshape(*depth.shape, 4 * CHANNELS)[..., 12:]
        colours[:] = 0
        if picture is not None:
            # Little-endian 0x00RRGGBB.
            colours[..., :3] = picture[..., ::-1]
