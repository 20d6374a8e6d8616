"""What draws the pictures of the cameras, whatever it draws with."""

from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.errors import CameraError
from arm_gazebo.sensors.camera import CameraSensor

VISIBLE_GROUPS = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)
"""Geom groups that a camera sees: all but the collision shapes of group 3 and above."""


class Renderer(Protocol):
    """Draws what a camera sees. One thread makes, uses and closes it."""

    @property
    def backend(self) -> str:
        """Name of the backend: egl, osmesa or raycast."""
        ...

    def set_model(self, model: mujoco.MjModel) -> None:
        """Draw this model from now on; the caller gives it away: the renderer may change it."""
        ...

    def render(
        self,
        data: mujoco.MjData,
        sensor: CameraSensor,
        picture: NDArray[np.uint8] | None,
        depth: NDArray[np.float32] | None = None,
    ) -> None:
        """Draw one camera's view of a state of the model: its colours, its depth, or both.

        Args:
            data: state with up-to-date frames of geoms, cameras and lights.
            sensor: the camera; one of those that the renderer was made for.
            picture: (height, width, 3) C-contiguous RGB, overwritten; row 0 is the top.
            depth: (height, width) C-contiguous distances along the camera's axis in m,
                overwritten; infinite where nothing is drawn.
        """
        ...

    def close(self) -> None:
        """Free what the renderer holds; it cannot be used again."""
        ...


def camera_id(model: mujoco.MjModel, sensor: CameraSensor) -> int:
    """Return the index of a sensor's camera in the model.

    Raises:
        CameraError: the model has no camera of that name.
    """
    index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_CAMERA, sensor.name)
    if index < 0:
        names = [model.camera(i).name for i in range(model.ncam)]
        raise CameraError(
            f"the model has no camera {sensor.name!r}; it has {', '.join(names) or 'none'}"
        )
    return index
