"""Pictures and depth of a world, by every backend of this machine."""

import ctypes
import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict, replace
from functools import cache
from pathlib import Path

import mujoco
import numpy as np
import pytest

from arm_gazebo.rendering.raycast_renderer import RaycastRenderer
from arm_gazebo.sensors.camera import CameraSensor

DRAW_PICTURE = Path(__file__).with_name("draw_picture.py")
LIBRARIES = {"egl": "libEGL.so.1", "osmesa": "libOSMesa.so.8"}

Seen = tuple[np.ndarray, np.ndarray]
See = Callable[[str, CameraSensor], Seen]


def is_installed(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


GL_BACKENDS = [
    pytest.param(name, marks=pytest.mark.gl)
    for name, library in LIBRARIES.items()
    if is_installed(library)
]


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run what asks for a `backend` by each of them, and for a `gl_backend` by each OpenGL."""
    if "backend" in metafunc.fixturenames:
        metafunc.parametrize("backend", ["raycast", *GL_BACKENDS])
    if "gl_backend" in metafunc.fixturenames:
        metafunc.parametrize("gl_backend", GL_BACKENDS)


class Painter:
    """A process that draws with one OpenGL backend."""

    def __init__(self, backend: str, folder: Path) -> None:
        self._folder = folder
        self._process = subprocess.Popen(
            [sys.executable, str(DRAW_PICTURE), backend],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def see(self, mjcf: str, sensor: CameraSensor) -> Seen:
        """Return picture and depth of a world."""
        (self._folder / "m.xml").write_text(mjcf)
        (self._folder / "s.json").write_text(json.dumps(asdict(sensor)))
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(f"{self._folder}\n")
        self._process.stdin.flush()
        assert self._process.stdout.readline() == f"{self._folder}\n"
        return np.load(self._folder / "p.npy"), np.load(self._folder / "d.npy")

    def close(self) -> None:
        """End the process."""
        self._process.communicate()


def see_by_rays(mjcf: str, sensor: CameraSensor) -> Seen:
    """Return picture and depth of a world, drawn anew, each pixel by a ray of its own."""
    model = mujoco.MjModel.from_xml_string(mjcf)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    picture = np.zeros((sensor.height, sensor.width, 3), np.uint8)
    depth = np.zeros((sensor.height, sensor.width), np.float32)
    renderer = RaycastRenderer()
    renderer.set_model(model)
    renderer.render(data, replace(sensor, rate_hz=0.0), picture, depth)
    return picture, depth


@pytest.fixture
def see_anew() -> See:
    """Return what draws a world by rays, each time anew."""
    return see_by_rays


@pytest.fixture(scope="package")
def see_by(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[..., Seen]]:
    """Return what draws a world with a backend; the same world is drawn once."""
    painters: dict[str, Painter] = {}

    @cache
    def drawn(backend: str, mjcf: str, sensor: CameraSensor) -> Seen:
        if backend == "raycast":
            return see_by_rays(mjcf, sensor)
        if backend not in painters:
            painters[backend] = Painter(backend, tmp_path_factory.mktemp(backend))
        return painters[backend].see(mjcf, sensor)

    def see(backend: str, mjcf: str, sensor: CameraSensor) -> Seen:
        picture, depth = drawn(backend, mjcf, sensor)
        return picture.copy(), depth.copy()

    yield see
    for painter in painters.values():
        painter.close()


# One OpenGL is enough: `test_pictures` compares them.
@pytest.fixture(params=["raycast", *GL_BACKENDS[:1]])
def see(request: pytest.FixtureRequest, see_by: Callable[..., Seen]) -> See:
    """Return what draws a world (MJCF): the picture, with every pixel, and the depth."""
    return lambda mjcf, sensor: see_by(request.param, mjcf, sensor)
