"""Draws pictures and their depth with one OpenGL backend and saves them; a program of its own.

Two OpenGL libraries do not live in one process, and a broken one may end it.

usage: draw_picture.py BACKEND

Each line of its input names a folder with a model (m.xml) and a camera (s.json). It saves the
picture (p.npy) and the depth (d.npy) there, and prints the folder's name.
"""

import json
import sys
from pathlib import Path

import mujoco
import numpy as np

from arm_gazebo.rendering.backend_selection import open_renderer
from arm_gazebo.rendering.pinhole_view import drawn_size
from arm_gazebo.sensors.camera import CameraSensor


def draw(backend: str, folder: Path) -> None:
    """Draw the model twice, for a renderer has to take a new model, too."""
    values = json.loads((folder / "s.json").read_text())
    sensor = CameraSensor(**{k: tuple(v) if isinstance(v, list) else v for k, v in values.items()})
    picture = np.zeros((sensor.height, sensor.width, 3), np.uint8)
    depth = np.zeros((sensor.height, sensor.width), np.float32)
    renderer = open_renderer([backend], *drawn_size([sensor]))
    assert renderer.backend == backend
    for _ in range(2):
        model = mujoco.MjModel.from_xml_path(str(folder / "m.xml"))
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        renderer.set_model(model)
        renderer.render(data, sensor, picture, depth)
    renderer.close()
    np.save(folder / "p.npy", picture)
    np.save(folder / "d.npy", depth)


if __name__ == "__main__":
    for line in sys.stdin:
        draw(sys.argv[1], Path(line.rstrip("\n")))
        print(line, end="", flush=True)
