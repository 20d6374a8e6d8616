"""Choice of what draws the cameras' pictures: the first backend that draws a test picture."""

import logging
from collections.abc import Callable, Iterable

import mujoco
import numpy as np

from arm_gazebo.errors import BackendError, CameraError
from arm_gazebo.rendering.gl_context import EglContext, GlContext, OsmesaContext
from arm_gazebo.rendering.gl_renderer import GlRenderer
from arm_gazebo.rendering.raycast_renderer import RaycastRenderer
from arm_gazebo.rendering.renderer import Renderer
from arm_gazebo.sensors.camera import CameraSensor

logger = logging.getLogger(__name__)

RAYCAST = "raycast"
CONTEXTS: dict[str, Callable[[], GlContext]] = {"egl": EglContext, "osmesa": OsmesaContext}
BACKENDS = (*CONTEXTS, RAYCAST)
"""In the order of preference; the last one always works."""
PREFERENCES = ("auto", *BACKENDS)

FIX = "apt install libegl1 libgl1-mesa-dri (or libosmesa6)"
TEST_SENSOR = CameraSensor("self_test", "", "", width=64, height=48)
TEST_SCENE = """
<mujoco>
  <worldbody>
    <light pos="0 0 2"/>
    <camera name="self_test" pos="0 0 1"/>
    <geom type="sphere" size="0.2" rgba="1 0 0 1"/>
  </worldbody>
</mujoco>
"""
LEAST_CONTRAST = 50
"""Of 255, between the brightest and the darkest value of the test picture."""


def backend_order(preference: str, excluded: Iterable[str] = ()) -> tuple[str, ...]:
    """Return the backends to try, in this order; ray casting is always the last of them.

    Args:
        preference: auto, or the one to try before falling back to ray casting.
        excluded: backends known not to work here; ray casting cannot be excluded.

    Raises:
        CameraError: an unknown preference; the message names the known ones.
    """
    if preference not in PREFERENCES:
        raise CameraError(f"no render backend {preference!r}; there are {', '.join(PREFERENCES)}")
    wanted = CONTEXTS if preference == "auto" else [preference]
    shut_out = {*excluded, RAYCAST}
    return (*(name for name in wanted if name not in shut_out), RAYCAST)


def open_renderer(
    order: Iterable[str],
    max_width: int,
    max_height: int,
    on_try: Callable[[str], None] = lambda _backend: None,
) -> Renderer:
    """Return a renderer of the first backend that works, after one test picture.

    Args:
        order: names of backends, see `backend_order`.
        max_width: width in pixels of the widest picture.
        max_height: height in pixels of the highest picture.
        on_try: called with a backend's name before it is touched: a broken driver may end the
            process.

    Raises:
        BackendError: an OpenGL library started, but does not draw. It cannot be unloaded: no
            other OpenGL library works in this process any more.
    """
    reasons: list[str] = []
    for backend in order:
        on_try(backend)
        if backend == RAYCAST:
            if reasons:
                _warn(reasons)
            return RaycastRenderer()
        try:
            context = CONTEXTS[backend]()
        except CameraError as error:
            reasons.append(str(error))
            continue
        # The test picture may be the largest of all.
        width, height = max(max_width, TEST_SENSOR.width), max(max_height, TEST_SENSOR.height)
        renderer = GlRenderer(context, width, height)
        _test(renderer)
        return renderer
    raise CameraError("no render backend to try")


def _test(renderer: Renderer) -> None:
    """Draw a red ball before black.

    Raises:
        BackendError: it cannot be seen.
    """
    model = mujoco.MjModel.from_xml_string(TEST_SCENE)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    picture = np.zeros((TEST_SENSOR.height, TEST_SENSOR.width, 3), np.uint8)
    try:
        renderer.set_model(model)
        renderer.render(data, TEST_SENSOR, picture)
    except mujoco.FatalError as error:
        raise BackendError(f"{renderer.backend} does not draw: {error}") from error
    if int(picture.max()) - int(picture.min()) < LEAST_CONTRAST:
        raise BackendError(f"{renderer.backend} draws an empty picture")


def _warn(reasons: list[str]) -> None:
    logger.warning(
        "no OpenGL for the cameras (%s): their pictures are ray-cast, without textures and "
        "highlights, and slower; for OpenGL: %s",
        "; ".join(reasons),
        FIX,
    )
