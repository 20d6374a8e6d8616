"""The interface of every renderer of camera images."""

from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.errors import CameraError
from arm_gazebo.sensors.camera import CameraSensor

VISIBLE_GROUPS = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)
"""Geom groups that a camera sees: all except the collision shapes in group 3 and above."""


class Renderer(Protocol):
    """Renders a camera's view. One thread creates, uses and closes it."""

    @property
    def backend(self) -> str:
        """Name of the backend: egl, osmesa or raycast."""
        ...

    def set_model(self, model: mujoco.MjModel) -> None:
        """Render this model from now on. The renderer owns it and may modify it."""
        ...

    def render(
        self,
        data: mujoco.MjData,
        sensor: CameraSensor,
        picture: NDArray[np.uint8] | None,
        depth: NDArray[np.float32] | None = None,
    ) -> None:
        """Render one camera's view of a state of the model: colours, depth, or both.

        Args:
            data: state with up-to-date frames of geoms, cameras and lights.
            sensor: the camera; one of those that the renderer was created for.
            picture: (height, width, 3) C-contiguous RGB, overwritten; row 0 is the top.
            depth: (height, width) C-contiguous distances along the camera's axis in m,
                overwritten; infinite where nothing is drawn.
        """
        ...

    def close(self) -> None:
        """Free the renderer's resources; it cannot be used again."""
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
