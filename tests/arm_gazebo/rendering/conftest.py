"""Pictures and depth of a world, by every backend of this machine."""

import ctypes
import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from arm_gazebo.rendering.raycast_renderer import RaycastRenderer
from arm_gazebo.sensors.camera import CameraSensor

DRAW_PICTURE = Path(__file__).with_name("draw_picture.py")
LIBRARIES = {"egl": "libEGL.so.1", "osmesa": "libOSMesa.so.8"}

See = Callable[[str, CameraSensor], tuple[np.ndarray, np.ndarray]]


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


# One OpenGL is enough: `test_pictures` compares them.
@pytest.fixture(params=["raycast", *GL_BACKENDS[:1]])
def see(request: pytest.FixtureRequest, tmp_path: Path) -> See:
    """Return what draws a world (MJCF): the picture, with every pixel, and the depth."""

    def with_rays(mjcf: str, sensor: CameraSensor) -> tuple[np.ndarray, np.ndarray]:
        model = mujoco.MjModel.from_xml_string(mjcf)
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        picture = np.zeros((sensor.height, sensor.width, 3), np.uint8)
        depth = np.zeros((sensor.height, sensor.width), np.float32)
        renderer = RaycastRenderer()
        renderer.set_model(model)
        renderer.render(data, replace(sensor, rate_hz=0.0), picture, depth)
        return picture, depth

    def with_gl(mjcf: str, sensor: CameraSensor) -> tuple[np.ndarray, np.ndarray]:
        files = [tmp_path / name for name in ("m.xml", "s.json", "p.npy", "d.npy")]
        files[0].write_text(mjcf)
        files[1].write_text(json.dumps(asdict(sensor)))
        command = [sys.executable, str(DRAW_PICTURE), request.param, *map(str, files)]
        run = subprocess.run(command, capture_output=True, text=True, timeout=60)
        assert run.returncode == 0, run.stderr
        return np.load(files[2]), np.load(files[3])

    return with_rays if request.param == "raycast" else with_gl
