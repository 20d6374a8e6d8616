"""Render one image with the first backend that works; run as a child process of `arm doctor`.

It prints the name of each backend before it tries it, so the last line names the backend that was
used or that crashed the process.
"""

import sys
from collections.abc import Sequence

import mujoco
import numpy as np

from arm_gazebo.rendering.backend_selection import (
    TEST_SCENE,
    TEST_SENSOR,
    backend_order,
    open_renderer,
)


def main(excluded: Sequence[str]) -> int:
    """Render the image with any backend except the excluded ones; return the exit code."""
    width, height = TEST_SENSOR.width, TEST_SENSOR.height
    renderer = open_renderer(backend_order("auto", excluded), width, height, on_try=_print_name)
    model = mujoco.MjModel.from_xml_string(TEST_SCENE)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    picture = np.zeros((height, width, 3), np.uint8)
    renderer.set_model(model)
    renderer.render(data, TEST_SENSOR, picture)
    renderer.close()
    return 0 if picture.any() else 1


def _print_name(backend: str) -> None:
    sys.stdout.write(f"{backend}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
