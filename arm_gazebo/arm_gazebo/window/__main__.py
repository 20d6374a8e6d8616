"""The window process: MuJoCo's viewer shows the states that the simulation sends.

The simulation starts it; nobody starts it by hand. It ends when the simulation ends. Actions in the
window change the view, never the simulation.
"""

import argparse
import math
import os
import sys
import threading
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

import mujoco

from arm_description.view_fitting import View
from arm_gazebo.errors import GazeboError, WindowError
from arm_gazebo.feed.child_process import add_parent_arguments, follow_parent
from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_gazebo.feed.socket_pair import CameraEnd, ModelMessage
from arm_gazebo.rendering.scene import RenderScene, read_model
from arm_gazebo.window.first_view import first_view
from arm_gazebo.window.process import EXIT_CLOSED, EXIT_FAILED, EXIT_NEW_MODEL
from arm_node.printable import printable_message

if TYPE_CHECKING:
    from mujoco.viewer import Handle

JOIN_TIMEOUT_S = 2.0
DEFAULT_VIEW = View((1.5, -1.5, 1.2), (0.0, 0.0, 0.3))
"""The view of an empty world."""
SHADOW_SIZE = 2048
"""Side of the shadow map in pixels; the model's own is small, for software-rendered cameras."""


def main(argv: Sequence[str] | None = None) -> int:
    """Show the simulation until it ends or the window is closed; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, allow_abbrev=False)
    add_parent_arguments(parser)
    arguments = parser.parse_args(argv)
    try:
        follow_parent(arguments.parent)
        channel = CameraEnd(arguments.socket)
        _check_toolkit()
        return _show(channel)
    except GazeboError as error:
        sys.stderr.write(f"{printable_message(str(error))}\n")
        return EXIT_FAILED


def _check_toolkit() -> None:
    """Raise a WindowError if no window can open; MuJoCo's viewer would end the process."""
    import glfw

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        working = glfw.init()
    if not working:
        reasons = "; ".join(str(warning.message) for warning in caught)
        display = os.environ.get("DISPLAY", "")
        raise WindowError(f"cannot open a window on DISPLAY={display}: {reasons}")


def _show(channel: CameraEnd) -> int:
    scene = _first_scene(channel)
    if scene is None:
        return EXIT_CLOSED
    with _viewer(scene) as viewer:
        view: View | None = None
        while viewer.is_running():
            messages = channel.receive()
            if messages is None:
                break
            states = [message for message in messages if isinstance(message, CameraSnapshot)]
            if len(states) < len(messages):
                return EXIT_NEW_MODEL
            if states and view is None:
                view = _view(scene, states[-1])
                _place_camera(viewer, view)
            if states:
                # Older states would never be visible.
                with viewer.lock():
                    scene.pose(states[-1])
                viewer.sync()
    return EXIT_CLOSED


def _view(scene: RenderScene, state: CameraSnapshot) -> View:
    """Return the first view of a state. It is slow, and does not disturb the drawing."""
    data = mujoco.MjData(scene.model)
    data.qpos[:] = state.qpos
    data.mocap_pos[:] = state.mocap_positions
    data.mocap_quat[:] = state.mocap_quaternions
    mujoco.mj_kinematics(scene.model, data)
    return first_view(scene.model, data) or DEFAULT_VIEW


def _place_camera(viewer: "Handle", view: View) -> None:
    x, y, z = (t - p for t, p in zip(view.target, view.position, strict=True))
    with viewer.lock():
        viewer.cam.lookat[:] = view.target
        viewer.cam.distance = math.hypot(x, y, z)
        viewer.cam.azimuth = math.degrees(math.atan2(y, x))
        viewer.cam.elevation = math.degrees(math.atan2(z, math.hypot(x, y)))


def _first_scene(channel: CameraEnd) -> RenderScene | None:
    """Wait for the model; return None if the simulation ends first."""
    while (messages := channel.receive()) is not None:
        models = [message for message in messages if isinstance(message, ModelMessage)]
        if models:
            with open(models[-1].file, "rb") as file:
                scene = RenderScene(read_model(file.fileno()))
            scene.model.vis.quality.shadowsize = SHADOW_SIZE
            return scene
    return None


@contextmanager
def _viewer(scene: RenderScene) -> "Iterator[Handle]":
    import mujoco.viewer

    before = set(threading.enumerate())
    # The side panels would offer to pause and to push, which this window cannot do.
    handle = mujoco.viewer.launch_passive(
        scene.model, scene.data, show_left_ui=False, show_right_ui=False
    )
    try:
        yield handle
    finally:
        handle.close()
        # If the window still draws when the process ends, the process crashes.
        for thread in set(threading.enumerate()) - before:
            thread.join(JOIN_TIMEOUT_S)


if __name__ == "__main__":
    sys.exit(main())
