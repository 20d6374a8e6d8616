"""Render without OpenGL, by casting rays into the scene with MuJoCo's collision code.

Few rays are enough, with more only where something changes. Samples are first taken on a coarse
lattice. A point between two similar samples gets their mean; a point between two different samples
is sampled. Repeating this until every pixel is filled costs a fraction of a sample per pixel and
keeps edges sharp. Objects thinner than the coarse lattice's step may be missed.
"""

import math
import time
from collections.abc import Callable

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.rendering.renderer import VISIBLE_GROUPS, camera_id
from arm_gazebo.rendering.surface_colours import SurfaceColours
from arm_gazebo.sensors.camera import CameraSensor

HIDDEN_GROUP = len(VISIBLE_GROUPS) - 1
MAX_HIDDEN_LAYERS = 4
"""Limit on the hidden surfaces that one ray passes through."""


class RaycastRenderer:
    """Renders diffuse surfaces in plain colours, without textures, highlights and shadows.

    If the machine cannot keep the camera's rate, small objects may be missed; see
    `fill_picture` and `SamplingStep`.
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


class Lighting:
    """The head light and the active lights of one state of a model, as seen by one camera."""

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, forward: NDArray[np.float64]
    ) -> None:
        """Collect the lights, whose frames in `data` are up to date.

        The head light shines along the unit vector `forward`, (3,).
        """
        self._model = model
        self._data = data
        self._forward = forward
        self._active = [int(index) for index in np.flatnonzero(model.light_active)]

    def brightness(
        self, points: NDArray[np.float64], normals: NDArray[np.float64]
    ) -> NDArray[np.float32]:
        """Return the brightness (n, 3) of white surfaces, 1 for fully lit.

        The points (n, 3) are in m; the normals (n, 3) have length 1 and point outwards.
        """
        light = np.zeros(points.shape, np.float32)
        head = self._model.vis.headlight
        if head.active:
            facing = np.maximum(-(normals @ self._forward), 0.0)[:, np.newaxis]
            light += np.asarray(head.ambient) + facing * np.asarray(head.diffuse)
        for index in self._active:
            light += self._model.light_ambient[index]
            light += (
                self._diffuse(index, points, normals)[:, np.newaxis]
                * (self._model.light_diffuse[index])
            )
        return light

    def _diffuse(
        self, index: int, points: NDArray[np.float64], normals: NDArray[np.float64]
    ) -> NDArray[np.float32]:
        direction = self._data.light_xdir[index]
        kind = self._model.light_type[index]
        if kind == mujoco.mjtLightType.mjLIGHT_DIRECTIONAL:
            return np.maximum(-(normals @ direction), 0.0).astype(np.float32)
        beams = points - self._data.light_xpos[index]
        distances = np.maximum(np.linalg.norm(beams, axis=1), 1e-9)
        beams /= distances[:, np.newaxis]
        facing = np.maximum(-np.einsum("ij,ij->i", normals, beams), 0.0)
        constant, linear, square = self._model.light_attenuation[index]
        facing /= constant + distances * (linear + distances * square)
        if kind == mujoco.mjtLightType.mjLIGHT_SPOT:
            inside = beams @ direction
            edge = math.cos(math.radians(float(self._model.light_cutoff[index])))
            facing *= np.where(inside > edge, inside, 0.0) ** self._model.light_exponent[index]
        return facing.astype(np.float32)


FIRST_SAMPLES = 45_000
"""Limit on the lattice rays of the first image; later images adapt to the time it took."""
MAX_STEP = 8
AVERAGED_FRAMES = 10
AFFORDABLE = 0.8
"""Fraction of the frame period that rendering may take."""
FINER_COST = 4.0
"""Halving the step multiplies the number of rays by at most this factor."""


class SamplingStep:
    """The step of the coarse lattice in pixels, a power of two, for one camera.

    For a camera with a rate of 0, whose next image nobody waits for, every pixel is cast.

    Attributes:
        step: the step for the next image.
    """

    def __init__(self, width: int, height: int, rate_hz: float) -> None:
        self.step = 1
        self._affordable_s = AFFORDABLE / rate_hz if rate_hz else math.inf
        while rate_hz and self.step < MAX_STEP and width * height > FIRST_SAMPLES * self.step**2:
            self.step *= 2
        self._start_average()

    def note(self, duration_s: float) -> None:
        """Adapt the step to the time in s that an image took to render."""
        self._sum_s += duration_s
        self._count += 1
        if self._count < AVERAGED_FRAMES:
            return
        mean_s = self._sum_s / self._count
        if mean_s > self._affordable_s and self.step < MAX_STEP:
            self.step *= 2
        elif mean_s * FINER_COST < self._affordable_s and self.step > 1:
            self.step //= 2
        self._start_average()

    def _start_average(self) -> None:
        self._sum_s = 0.0
        self._count = 0


Picture = NDArray[np.uint8]
Sample = Callable[[NDArray[np.intp], NDArray[np.intp]], Picture]
"""Returns the colours (n, 3) of the pixels with these rows and columns, (n,) each."""

ALIKE_MASK = 0xF8
"""Two colours are similar if no channel differs in these bits, that is by 8 or more of 255."""


def fill_picture(picture: Picture, step: int, sample: Sample) -> None:
    """Fill an image (height, width, 3).

    Args:
        picture: the image, which is overwritten.
        step: step of the coarse lattice in pixels, a power of two; 1 samples every pixel.
        sample: returns colours; it is also called for pixels up to `step` beyond the right and
            lower edges.
    """
    height, width, _ = picture.shape
    rows, columns = (np.arange(0, size - 1 + step, step) for size in (height, width))
    level = _sample_lattice(rows, columns, sample)
    while step > 1:
        step //= 2
        level = _insert_columns(level, step, sample)
        level = _insert_rows(level, step, sample)
    np.copyto(picture, level[:height, :width])


def _sample_lattice(rows: NDArray[np.intp], columns: NDArray[np.intp], sample: Sample) -> Picture:
    colours = sample(np.repeat(rows, len(columns)), np.tile(columns, len(rows)))
    return colours.reshape(len(rows), len(columns), 3)


def _insert_columns(level: Picture, step: int, sample: Sample) -> Picture:
    """Insert a column between every two; rows stay 2 * step apart, columns become step apart."""
    finer = np.empty((level.shape[0], 2 * level.shape[1] - 1, 3), np.uint8)
    finer[:, ::2] = level
    means, differ = _compare(level[:, :-1], level[:, 1:])
    rows, columns = np.nonzero(differ)
    means[rows, columns] = sample(rows * 2 * step, (2 * columns + 1) * step)
    finer[:, 1::2] = means
    return finer


def _insert_rows(level: Picture, step: int, sample: Sample) -> Picture:
    """Insert a row between every two; columns are already step apart."""
    finer = np.empty((2 * level.shape[0] - 1, level.shape[1], 3), np.uint8)
    finer[::2] = level
    means, differ = _compare(level[:-1], level[1:])
    rows, columns = np.nonzero(differ)
    means[rows, columns] = sample((2 * rows + 1) * step, columns * step)
    finer[1::2] = means
    return finer


def _compare(a: Picture, b: Picture) -> tuple[Picture, NDArray[np.bool_]]:
    """Return the means of two arrays of colours, and a mask of where they are not similar."""
    means: Picture = (a >> np.uint8(1)) + (b >> np.uint8(1)) + (a & b & np.uint8(1))
    gap = np.maximum(a, b) - np.minimum(a, b)
    return means, ((gap[..., 0] | gap[..., 1] | gap[..., 2]) & ALIKE_MASK).astype(np.bool_)
