"""Render without OpenGL, by casting rays into the scene with MuJoCo's collision code."""

import time

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.rendering.adaptive_sampling import MAX_STEP, SamplingStep, fill_picture
from arm_gazebo.rendering.lighting import Lighting
from arm_gazebo.rendering.renderer import VISIBLE_GROUPS, camera_id
from arm_gazebo.rendering.surface_colours import SurfaceColours
from arm_gazebo.sensors.camera import CameraSensor

HIDDEN_GROUP = len(VISIBLE_GROUPS) - 1
MAX_HIDDEN_LAYERS = 4
"""Limit on the hidden surfaces that one ray passes through."""


class RaycastRenderer:
    """Renders diffuse surfaces in plain colours, without textures, highlights and shadows.

    If the machine cannot keep the camera's rate, small objects may be missed; see
    `adaptive_sampling` and `SamplingStep`.
    """

    backend = "raycast"

    def __init__(self) -> None:
        self._model: mujoco.MjModel | None = None
        self._rays: dict[CameraSensor, NDArray[np.float64]] = {}
        self._steps: dict[CameraSensor, SamplingStep] = {}

    def set_model(self, model: mujoco.MjModel) -> None:
        """Draw this model from now on; see `Renderer.set_model`."""
        self._model = model
        self._colours = SurfaceColours(model)
        self._steps.clear()

    def render(
        self,
        data: mujoco.MjData,
        sensor: CameraSensor,
        picture: NDArray[np.uint8] | None,
        depth: NDArray[np.float32] | None = None,
    ) -> None:
        """Draw one camera's view; see `Renderer.render`."""
        assert self._model is not None
        if sensor not in self._rays:
            self._rays[sensor] = _pixel_rays(sensor)
        if sensor not in self._steps:
            self._steps[sensor] = SamplingStep(sensor.width, sensor.height, sensor.rate_hz)
        view = _View(self._model, data, self._colours, sensor, self._rays[sensor])
        if picture is not None:
            sampling = self._steps[sensor]
            start_s = time.perf_counter()
            fill_picture(picture, sampling.step, view.sample)
            sampling.note(time.perf_counter() - start_s)
        if depth is not None:
            np.copyto(depth, view.distances(*depth.shape))

    def close(self) -> None:
        """Do nothing: the renderer holds no resources."""


class _View:
    """One camera's view of one state of the model."""

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        colours: SurfaceColours,
        sensor: CameraSensor,
        pixel_rays: NDArray[np.float64],
    ) -> None:
        camera = camera_id(model, sensor)
        self._model, self._data, self._colours, self._sensor = model, data, colours, sensor
        self._position = data.cam_xpos[camera].copy()
        self._rotation = data.cam_xmat[camera].reshape(3, 3)
        self._pixel_rays = pixel_rays
        self._lighting = Lighting(model, data, -self._rotation[:, 2])

    def sample(self, rows: NDArray[np.intp], columns: NDArray[np.intp]) -> NDArray[np.uint8]:
        """Return the colours (n, 3) seen at pixels."""
        rays = self._pixel_rays[rows, columns] @ self._rotation.T
        geoms, distances, normals = self._cast(rays, self._sensor.near)
        hit = geoms >= 0
        # Sky everywhere first; pixels that hit a geom are overwritten.
        light = self._colours.sky(rays)
        points = self._position + rays[hit] * distances[hit, np.newaxis]
        brightness = self._lighting.brightness(points, normals[hit])
        light[hit] = self._colours.lit(geoms[hit], brightness)
        return (light * 255.0 + 0.5).astype(np.uint8)

    def distances(self, height: int, width: int) -> NDArray[np.float64]:
        """Return the depth (height, width) of every pixel, infinite where no geom is hit."""
        rays = self._pixel_rays[:height, :width].reshape(-1, 3) @ self._rotation.T
        geoms, distances, _normals = self._cast(rays, self._sensor.nearest_drawn)
        return np.where(geoms < 0, np.inf, distances).reshape(height, width)

    def _cast(
        self, rays: NDArray[np.float64], near: float
    ) -> tuple[NDArray[np.int32], NDArray[np.float64], NDArray[np.float64]]:
        """Return geom (-1 for none), depth and normal of each ray's first hit beyond the near clip.

        As in OpenGL, rays pass through surfaces nearer than that and surfaces seen from behind:
        their geoms are hidden from the rays that hit them, layer by layer.
        """
        geoms, depths, normals = self._cast_once(rays)
        groups = self._model.geom_group
        shown = groups.copy()
        for _ in range(MAX_HIDDEN_LAYERS):
            back_faces = np.einsum("ij,ij->i", normals, rays) > 0
            (hidden,) = np.nonzero((geoms >= 0) & (back_faces | (depths < near)))
            if not hidden.size:
                break
            groups[np.unique(geoms[hidden])] = HIDDEN_GROUP
            geoms[hidden], depths[hidden], normals[hidden] = self._cast_once(rays[hidden])
        groups[:] = shown
        return geoms, depths, normals

    def _cast_once(
        self, rays: NDArray[np.float64]
    ) -> tuple[NDArray[np.int32], NDArray[np.float64], NDArray[np.float64]]:
        count = len(rays)
        geoms = np.full(count, -1, np.int32)
        depths, normals = np.zeros(count), np.zeros((count, 3))
        if count:
            mujoco.mj_multiRay(
                *(self._model, self._data, self._position, rays.ravel()),
                *(VISIBLE_GROUPS, True, -1, geoms, depths, normals.reshape(-1)),
                *(count, self._sensor.far),
            )
        return geoms, depths, normals


def _pixel_rays(sensor: CameraSensor) -> NDArray[np.float64]:
    """Return the rays through the pixels' centres, with a margin at the right and lower edges.

    They are in MuJoCo's camera frame (x right, y up, looks along -z) and have depth 1, so the
    factor that scales a ray to a point is the point's depth. The margin goes on in a straight line,
    because the lens may not be known beyond the picture.
    """
    rays = np.full((sensor.height, sensor.width, 3), -1.0)
    rays[..., :2] = sensor.lens.rays(sensor.width, sensor.height) * (1.0, -1.0)
    margin = (0, MAX_STEP)
    return np.pad(rays, (margin, margin, (0, 0)), mode="reflect", reflect_type="odd")
