"""Add the robot's cameras to the model."""

import math
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np

from arm_description.transforms import rotation_from_rpy
from arm_gazebo.errors import ModelError
from arm_gazebo.sensors.camera import CameraSensor

FORWARD_TO_MUJOCO = np.array([0.5, 0.5, -0.5, -0.5])
"""Rotates a ROS camera (looks along x, z up) to MuJoCo's (looks along -z, y up), w x y z."""
PIXEL_M = 1e-6
"""Size of a pixel of a camera with <intrinsics>."""
MIN_BUFFER = 800
"""Smallest side of the off-screen buffer in pixels: a renderer may need more than a camera."""


def add_cameras(
    spec: mujoco.MjSpec, bodies: Mapping[str, mujoco.MjsBody], cameras: Sequence[CameraSensor]
) -> None:
    """Add each camera to its link's body under the sensor's name, and enlarge the render buffer.

    Raises:
        ModelError: a camera's link does not exist, or the world already has a camera of that name.
    """
    buffer = spec.visual.global_
    buffer.offwidth = max([MIN_BUFFER, buffer.offwidth, *(c.width for c in cameras)])
    buffer.offheight = max([MIN_BUFFER, buffer.offheight, *(c.height for c in cameras)])
    # Four samples a pixel and a shadow map of 4096 make a frame twenty times slower in software.
    spec.visual.quality.offsamples = 0
    spec.visual.quality.shadowsize = 512
    for camera in cameras:
        if camera.link not in bodies:
            raise ModelError(
                f"camera '{camera.name}' is on link '{camera.link}', which does not exist; "
                f"the robot has {', '.join(bodies)}"
            )
        if spec.camera(camera.name) is not None:
            raise ModelError(f"the world already has a camera '{camera.name}'; rename one of them")
        orientation, quaternion = np.zeros(4), np.zeros(4)
        mujoco.mju_mat2Quat(orientation, rotation_from_rpy(camera.rpy).ravel())
        mujoco.mju_mulQuat(quaternion, orientation, FORWARD_TO_MUJOCO)
        mounted = bodies[camera.link].add_camera(
            name=camera.name,
            pos=camera.xyz,
            quat=quaternion,
            resolution=[camera.width, camera.height],
        )
        _apply_lens(mounted, camera)


def _apply_lens(mounted: mujoco.MjsCamera, camera: CameraSensor) -> None:
    """Give a camera of the model the sensor's projection; MuJoCo has no distortion."""
    lens = camera.lens
    if not camera.intrinsics:
        mounted.fovy = math.degrees(2 * math.atan(camera.height / 2 / lens.fy))
        return
    # Only the ratio of the sensor's sides counts, because all lengths are in pixels.
    mounted.sensor_size = [camera.width * PIXEL_M, camera.height * PIXEL_M]
    mounted.focal_pixel = [lens.fx, lens.fy]
    # MuJoCo measures from the principal point to the middle of the picture.
    mounted.principal_pixel = [camera.width / 2 - lens.cx, camera.height / 2 - lens.cy]
