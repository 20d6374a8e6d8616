"""Draws one picture and its depth with one OpenGL backend and saves it; a program of its own.

Two OpenGL libraries do not live in one process, and a broken one may end it.

usage: draw_picture.py BACKEND MODEL.xml SENSOR.json PICTURE.npy DEPTH.npy
"""

import json
import sys

import mujoco
import numpy as np

from arm_gazebo.rendering.backend_selection import open_renderer
from arm_gazebo.rendering.pinhole_view import drawn_size
from arm_gazebo.sensors.camera import CameraSensor


def main() -> None:
    """Draw the model twice, for a renderer has to take a new model, too."""
    backend, model_file, sensor_file, picture_file, depth_file = sys.argv[1:]
    with open(sensor_file) as file:
        values = json.load(file)
    sensor = CameraSensor(**{k: tuple(v) if isinstance(v, list) else v for k, v in values.items()})
    picture = np.zeros((sensor.height, sensor.width, 3), np.uint8)
    depth = np.zeros((sensor.height, sensor.width), np.float32)
    renderer = open_renderer([backend], *drawn_size([sensor]))
    assert renderer.backend == backend
    for _ in range(2):
        model = mujoco.MjModel.from_xml_path(model_file)
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        renderer.set_model(model)
        renderer.render(data, sensor, picture, depth)
    renderer.close()
    np.save(picture_file, picture)
    np.save(depth_file, depth)


if __name__ == "__main__":
    main()
