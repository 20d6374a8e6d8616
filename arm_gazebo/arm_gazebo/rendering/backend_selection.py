"""Choose the cameras' render backend: the first one that renders a test image.

`arm doctor` runs it as a child process, which renders one image. It prints the name of each backend
before it tries it, so the last line names the backend that was used or that crashed the process.
"""

import logging
import sys
from collections.abc import Callable, Iterable, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.errors import BackendError, CameraError
from arm_gazebo.rendering.gl_context import EglContext, GlContext, OsmesaContext
from arm_gazebo.rendering.gl_renderer import GlRenderer
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
MIN_CONTRAST = 50
"""Smallest difference, of 255, between the brightest and darkest value of the test image."""


def backend_order(preference: str, excluded: Iterable[str] = ()) -> tuple[str, ...]:
    """Return the backends to try, in order; the last one is always ray casting.

    Args:
        preference: auto, or the backend to try before falling back to ray casting.
        excluded: backends that are known not to work; ray casting cannot be excluded.

    Raises:
        CameraError: the preference is unknown; the message names the known ones.
    """
    if preference not in PREFERENCES:
        raise CameraError(f"no render backend {preference!r}; there are {', '.join(PREFERENCES)}")
    wanted = CONTEXTS if preference == "auto" else [preference]
    skipped = {*excluded, RAYCAST}
    return (*(name for name in wanted if name not in skipped), RAYCAST)


def open_renderer(
    order: Iterable[str],
    max_width: int,
    max_height: int,
    on_try: Callable[[str], None] = lambda _backend: None,
) -> Renderer:
    """Return a renderer with the first backend that works, after one test image.

    Args:
        order: names of backends, see `backend_order`.
        max_width: width in pixels of the widest image.
        max_height: height in pixels of the tallest image.
        on_try: called with a backend's name before it is tried, because a broken driver may crash
            the process.

    Raises:
        BackendError: an OpenGL library started but does not draw. It cannot be unloaded, so no
            other OpenGL library can work in this process.
    """
    reasons: list[str] = []
    for backend in order:
        on_try(backend)
        if backend == RAYCAST:
            if reasons:
                _warn(reasons)
            # Imported here: the simulation's process chooses a backend, but does not draw.
            from arm_gazebo.rendering.raycast_renderer import RaycastRenderer

            return RaycastRenderer()
        try:
            context = CONTEXTS[backend]()
        except CameraError as error:
            reasons.append(str(error))
            continue
        # The test image may be larger than every camera's.
        width, height = max(max_width, TEST_SENSOR.width), max(max_height, TEST_SENSOR.height)
        renderer = GlRenderer(context, width, height)
        _test(renderer)
        return renderer
    raise CameraError("no render backend to try")


def ball_picture(renderer: Renderer) -> NDArray[np.uint8]:
    """Return a red ball on black as the renderer draws it, shape (height, width, 3)."""
    model = mujoco.MjModel.from_xml_string(TEST_SCENE)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    picture = np.zeros((TEST_SENSOR.height, TEST_SENSOR.width, 3), np.uint8)
    renderer.set_model(model)
    renderer.render(data, TEST_SENSOR, picture)
    return picture


def _test(renderer: Renderer) -> None:
    """Raise a BackendError if the ball of the test picture is not visible."""
    try:
        picture = ball_picture(renderer)
    except mujoco.FatalError as error:
        raise BackendError(f"{renderer.backend} does not draw: {error}") from error
    if int(picture.max()) - int(picture.min()) < MIN_CONTRAST:
        raise BackendError(f"{renderer.backend} draws an empty image")


def _warn(reasons: list[str]) -> None:
    logger.warning(
        "no OpenGL for the cameras (%s): their images are ray-cast, which is slower and lacks "
        "textures and highlights; for OpenGL: %s",
        "; ".join(reasons),
        FIX,
    )


def main(excluded: Sequence[str]) -> int:
    """Render an image with any backend except the excluded ones; return the exit code."""
    width, height = TEST_SENSOR.width, TEST_SENSOR.height
    renderer = open_renderer(backend_order("auto", excluded), width, height, on_try=_print_name)
    picture = ball_picture(renderer)
    renderer.close()
    return 0 if picture.any() else 1


def _print_name(backend: str) -> None:
    sys.stdout.write(f"{backend}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
