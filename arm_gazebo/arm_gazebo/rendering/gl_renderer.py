"""Render with OpenGL, tuned for a software driver on a busy machine."""

import os

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.rendering.gl_context import GlContext
from arm_gazebo.rendering.pinhole_view import LensTable, PinholeView
from arm_gazebo.rendering.renderer import VISIBLE_GROUPS, camera_id
from arm_gazebo.sensors.camera import CameraSensor

FLOOR_HALF_SIZE = 100.0
"""Half size in m of the drawn part of an infinite plane, the range of Gazebo's cameras. MuJoCo's
own way to draw an infinite plane costs half of a frame on llvmpipe."""
FLOOR_GRID = 4.0
"""Spacing in m of the points where OpenGL lights an infinite plane if no lamp is near it. With
the default of 0.5 m a floor of this size has more vertices than everything else together."""

NO_DECORATION = mujoco.mjtCatBit.mjCAT_STATIC | mujoco.mjtCatBit.mjCAT_DYNAMIC
MAX_EXTRA_GEOMS = 100


class GlRenderer:
    """Renders with a current OpenGL context, without shadows, reflections and multisampling.

    The renderer owns the context. Call it only from the thread in which the context is current.
    Its buffers have `drawn_size` of its cameras.
    """

    def __init__(self, context: GlContext, max_width: int, max_height: int) -> None:
        self.backend = context.name
        self._context = context
        self._max_size = (max_width, max_height)
        self._raw = np.empty(max_width * max_height * 3, dtype=np.uint8)
        self._option = mujoco.MjvOption()
        self._option.geomgroup[:] = VISIBLE_GROUPS
        self._option.sitegroup[:] = 0
        self._camera = mujoco.MjvCamera()
        self._camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
        self._model: mujoco.MjModel | None = None
        self._drawing: mujoco.MjrContext | None = None
        self._views: dict[CameraSensor, tuple[PinholeView, LensTable | None]] = {}

    def set_model(self, model: mujoco.MjModel) -> None:
        """Upload a model's meshes and textures; see `Renderer.set_model`."""
        self._context.make_current()
        _lighten(model, *self._max_size)
        self._free_drawing()
        # MuJoCo reads this whenever it looks up the OpenGL functions.
        os.environ["MUJOCO_GL"] = self.backend
        drawing = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        # Far depths map to 0, where floats are finest, because the buffer is coarsest there.
        drawing.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, drawing)
        self._drawing = drawing
        self._scene = mujoco.MjvScene(model, maxgeom=model.ngeom + MAX_EXTRA_GEOMS)
        self._model = model

    def render(
        self,
        data: mujoco.MjData,
        sensor: CameraSensor,
        picture: NDArray[np.uint8] | None,
        depth: NDArray[np.float32] | None = None,
    ) -> None:
        """Draw one camera's view; see `Renderer.render`."""
        model, scene = self._model, self._scene
        assert model is not None
        self._context.make_current()
        self._camera.fixedcamid = camera_id(model, sensor)
        mujoco.mjv_updateScene(model, data, self._option, None, self._camera, NO_DECORATION, scene)
        scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = False
        scene.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = False
        view, table = self._view(sensor)
        if picture is not None:
            scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = True
            raw = self._raw[: view.height * view.width * 3].reshape(view.height, view.width, 3)
            self._draw(view, (sensor.near, sensor.far), raw, None)
            if table is None:
                # OpenGL's first row is the bottom one.
                np.copyto(picture, raw[::-1])
            else:
                table.bend_colours(raw, picture)
        if depth is not None:
            # The sky box would have a depth.
            scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = False
            buffer = np.empty((view.height, view.width), np.float32)
            clip = sensor.nearest_drawn, sensor.far
            self._draw(view, clip, None, buffer)
            buffer = buffer[::-1] if table is None else table.bend_depth(buffer)
            np.copyto(depth, _distances(buffer, *clip))

    def _view(self, sensor: CameraSensor) -> tuple[PinholeView, LensTable | None]:
        if sensor not in self._views:
            view = PinholeView.of(sensor)
            table = None if sensor.lens.is_pinhole else LensTable(sensor, view)
            self._views[sensor] = view, table
        return self._views[sensor]

    def _draw(
        self,
        view: PinholeView,
        clip: tuple[float, float],
        colours: NDArray[np.uint8] | None,
        depth: NDArray[np.float32] | None,
    ) -> None:
        assert self._drawing is not None
        _apply_optics(self._scene, view, *clip)
        area = mujoco.MjrRect(0, 0, view.width, view.height)
        mujoco.mjr_render(area, self._scene, self._drawing)
        mujoco.mjr_readPixels(colours, depth, area, self._drawing)

    def close(self) -> None:
        """Free the GL resources and the context."""
        self._context.make_current()
        self._free_drawing()
        self._context.free()

    def _free_drawing(self) -> None:
        if self._drawing is not None:
            self._drawing.free()
            self._drawing = None


def _lighten(model: mujoco.MjModel, width: int, height: int) -> None:
    """Turn off what is expensive with a software driver, and size the buffer for the images."""
    model.vis.quality.offsamples = 0
    model.vis.quality.shadowsize = 0
    model.vis.global_.offwidth = width
    model.vis.global_.offheight = height
    planes = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE)
    directional = model.light_type == mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
    coarse = bool(np.all(directional | ~model.light_active.astype(bool)))
    for plane in planes:
        width_depth_grid = model.geom_size[plane]
        infinite = width_depth_grid[:2] <= 0
        width_depth_grid[:2][infinite] = FLOOR_HALF_SIZE
        if coarse and infinite.any():
            width_depth_grid[2] = FLOOR_GRID


def _apply_optics(scene: mujoco.MjvScene, view: PinholeView, near: float, far: float) -> None:
    """Give the scene's cameras (one per eye, both the same) the view's frustum."""
    for eye in scene.camera:
        eye.frustum_center = near * (view.width / 2 - view.cx) / view.fx
        eye.frustum_width = near * view.width / 2 / view.fx
        eye.frustum_top = near * view.cy / view.fy
        eye.frustum_bottom = near * (view.cy - view.height) / view.fy
        eye.frustum_near = near
        eye.frustum_far = far


def _distances(buffer: NDArray[np.float32], near: float, far: float) -> NDArray[np.float32]:
    """Convert a depth buffer to distances; 0 is the far clip plane, 1 the near one."""
    distances = (near * far) / (near + buffer * (far - near))
    distances[buffer <= 0] = np.inf
    return distances
