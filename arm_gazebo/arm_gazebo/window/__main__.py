"""The window's process: MuJoCo's viewer on the states that the simulation sends.

It is started by the simulation, never by hand, and ends with it. What is done in the window
changes the view, never the simulation.
"""

import argparse
import os
import sys
import threading
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from arm_gazebo.errors import GazeboError, WindowError
from arm_gazebo.feed.channel import CameraEnd, ModelMessage
from arm_gazebo.feed.parent_process import add_parent_arguments, follow_parent
from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_gazebo.rendering.scene import Scene
from arm_gazebo.window.process import EXIT_CLOSED, EXIT_FAILED, EXIT_NEW_MODEL

if TYPE_CHECKING:
    from mujoco.viewer import Handle

JOIN_TIMEOUT_S = 2.0
SHADOW_SIZE = 2048
"""Side of the shadow map, in pixels: the model has a small one, for cameras on a processor."""


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
        sys.stderr.write(f"{error}\n")
        return EXIT_FAILED


def _check_toolkit() -> None:
    """Raise a WindowError where windows cannot be; MuJoCo's viewer would end the process."""
    import glfw

    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        working = glfw.init()
    if not working:
        reasons = "; ".join(str(warning.message) for warning in said)
        raise WindowError(f"no window on DISPLAY={os.environ.get('DISPLAY', '')}: {reasons}")


def _show(channel: CameraEnd) -> int:
    scene = _first_scene(channel)
    if scene is None:
        return EXIT_CLOSED
    with _viewer(scene) as viewer:
        while viewer.is_running():
            messages = channel.receive()
            if messages is None:
                break
            states = [message for message in messages if isinstance(message, CameraSnapshot)]
            if len(states) < len(messages):
                return EXIT_NEW_MODEL
            if states:
                # Older ones nobody would see any more.
                with viewer.lock():
                    scene.pose(states[-1])
                viewer.sync()
    return EXIT_CLOSED


def _first_scene(channel: CameraEnd) -> Scene | None:
    """Wait for the model; None where the simulation ends before."""
    while (messages := channel.receive()) is not None:
        models = [message for message in messages if isinstance(message, ModelMessage)]
        if models:
            with open(models[-1].file, "rb") as file:
                scene = Scene(file.fileno())
            scene.model.vis.quality.shadowsize = SHADOW_SIZE
            return scene
    return None


@contextmanager
def _viewer(scene: Scene) -> "Iterator[Handle]":
    import mujoco.viewer

    before = set(threading.enumerate())
    # The panels at the sides would offer to pause and to push what cannot be moved from here.
    handle = mujoco.viewer.launch_passive(
        scene.model, scene.data, show_left_ui=False, show_right_ui=False
    )
    try:
        yield handle
    finally:
        handle.close()
        # A window that is still drawing when the process ends takes it down in a crash.
        for thread in set(threading.enumerate()) - before:
            thread.join(JOIN_TIMEOUT_S)


if __name__ == "__main__":
    sys.exit(main())
