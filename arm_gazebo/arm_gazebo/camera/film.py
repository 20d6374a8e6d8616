"""Cameras that stand in a world and film it, while colours, light and views change at will."""

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_gazebo.physics.physics import Physics
from arm_gazebo.rendering.backend_selection import backend_order, open_renderer
from arm_gazebo.rendering.renderer import Renderer
from arm_gazebo.rendering.scene import RenderScene
from arm_gazebo.sensors.camera import CameraSensor

Images = NDArray[np.uint8]
Numbers = tuple[float, ...]
SUN = "sun"
"""The light of the shipped worlds."""


@dataclass(frozen=True, slots=True)
class Look:
    """How a world differs from its description in pictures.

    Attributes:
        colours: red, green and blue of the first shape of bodies, by name, 0 to 1.
        light: factors of the red, green and blue of all light.
        sun: what is added to the direction of the sun, (3,).
        cameras: by name, what is added to a camera's position in m, then to its orientation as a
            rotation vector in its own frame in rad, (6,).
    """

    colours: Mapping[str, Numbers]
    light: Numbers
    sun: Numbers
    cameras: Mapping[str, Numbers]


class FilmCrew:
    """Draws what cameras of the world see. The simulation's thread.

    Args:
        physics: the simulation, whose model stays the same.
        cameras: names of cameras in its world.
        width: of the images, in pixels.
        height: of the images, in pixels.
        backend: the render backend: auto, egl, osmesa or raycast.
    """

    def __init__(
        self, physics: Physics, cameras: Sequence[str], width: int, height: int, backend: str
    ) -> None:
        """Open the renderer, if there is a camera.

        Raises:
            CameraError, BackendError: no render backend works.
        """
        self._physics, self._size = physics, (height, width)
        self._sensors = {
            name: CameraSensor(name, "", "", width=width, height=height) for name in cameras
        }
        self._scene = RenderScene(copy.copy(physics.model))
        self._renderer: Renderer | None = None
        if cameras:
            self._renderer = open_renderer(backend_order(backend), width, height)
            self._renderer.set_model(self._scene.model)

    def show(self, look: Look) -> None:
        """Draw the world with a look from now on."""
        drawn, original = self._scene.model, self._physics.model
        drawn.geom_rgba[:] = original.geom_rgba
        for name, colour in look.colours.items():
            drawn.geom_rgba[drawn.body(name).geomadr[0], :3] = colour
        sun = drawn.light(SUN).id
        drawn.light_diffuse[sun] = original.light_diffuse[sun] * look.light
        direction = original.light_dir[sun] + look.sun
        drawn.light_dir[sun] = direction / np.linalg.norm(direction)
        ours, theirs = drawn.vis.headlight, original.vis.headlight
        ours.ambient[:] = theirs.ambient * look.light
        ours.diffuse[:] = theirs.diffuse * look.light
        for name, change in look.cameras.items():
            camera, turned = drawn.camera(name).id, original.camera(name).quat.copy()
            drawn.cam_pos[camera] = original.cam_pos[camera] + change[:3]
            mujoco.mju_quatIntegrate(turned, np.array(change[3:]), 1.0)
            drawn.cam_quat[camera] = turned

    def images(self) -> dict[str, Images]:
        """Return what the cameras see now, RGB, each of shape (height, width, 3)."""
        if self._renderer is None:
            return {}
        self._scene.pose(CameraSnapshot.of(self._physics.data, self._physics.time_s))
        found: dict[str, Images] = {}
        for name, sensor in self._sensors.items():
            found[name] = np.empty((*self._size, 3), np.uint8)
            self._renderer.render(self._scene.data, sensor, found[name])
        return found

    def close(self) -> None:
        """Free the renderer."""
        if self._renderer is not None:
            self._renderer.close()
