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
import numpy as np
from numpy.typing import NDArray

from arm_description.view_fitting import Body, Points, View, body_of, fit_view
from arm_gazebo.errors import GazeboError, WindowError
from arm_gazebo.feed.child_process import add_parent_arguments, follow_parent
from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_gazebo.feed.socket_pair import CameraEnd, ModelMessage
from arm_gazebo.rendering.scene import RenderScene, read_model
from arm_gazebo.window.process import EXIT_CLOSED, EXIT_FAILED, EXIT_NEW_MODEL
from arm_node.printable import printable_message

if TYPE_CHECKING:
    from mujoco.viewer import Handle

ASPECT = 1.3
"""Approximate aspect ratio of the window; a wider window shows more at the sides."""
GROUND_M, GROUND_THICKNESS_M = 5.0, 0.1
"""A geom at least this long and wide, and thinner than this, counts as ground."""
DRAWN_GROUPS = (0, 1, 2)
MAX_HITS = 20
"""Limit on a line's hits on robots, which do not block the view; beyond it the line is blocked."""
STEP = 1e-4
OPAQUE = 0.9


def first_view(model: mujoco.MjModel, data: mujoco.MjData) -> View | None:
    """Return the first view of a model in a state; None if there is nothing but ground.

    Everything that actuators move counts as a robot.
    """
    robots, things = [], []
    of_robots = _robot_geoms(model)
    for geom in range(model.ngeom):
        body = _body(model, data, geom)
        if body is not None:
            (robots if of_robots[geom] else things).append(body)

    def blocked(starts: Points, ends: Points) -> NDArray[np.bool_]:
        lines = zip(starts, ends, strict=True)
        return np.array([_is_blocked(model, data, of_robots, *line) for line in lines])

    return fit_view(robots, things, blocked, math.radians(model.vis.global_.fovy), ASPECT)


def _robot_geoms(model: mujoco.MjModel) -> NDArray[np.bool_]:
    """Return a mask of the geoms that belong to robots, shape (ngeom,)."""
    by_joint = model.actuator_trntype == mujoco.mjtTrn.mjTRN_JOINT
    joints = model.actuator_trnid[by_joint, 0]
    roots = np.unique(model.body_rootid[model.jnt_bodyid[joints]])
    return np.isin(model.body_rootid[model.geom_bodyid], roots)


def _body(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> Body | None:
    """Return the bounding body of a geom; None for the ground and for invisible geoms."""
    is_drawn = model.geom_group[geom] in DRAWN_GROUPS and _alpha(model, geom) > 0.0
    if not is_drawn or model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_PLANE:
        return None
    middle, half = model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]
    box = body_of(np.array([middle - half, middle + half])).corners
    body = body_of(box @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom])
    length, width, height = np.subtract(body.high, body.low)
    is_ground = min(length, width) >= GROUND_M and height < GROUND_THICKNESS_M
    return None if is_ground else body


def _alpha(model: mujoco.MjModel, geom: int) -> float:
    material = int(model.geom_matid[geom])
    rgba = model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]
    return float(rgba[3])


def _is_blocked(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    of_robots: NDArray[np.bool_],
    start: Points,
    end: Points,
) -> bool:
    """Return whether something between two points hides one from the other."""
    groups = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)
    line, geom, at = end - start, np.zeros(1, dtype=np.int32), 0.0
    for _ in range(MAX_HITS):
        hit = mujoco.mj_ray(model, data, start + at * line, line, groups, 1, -1, geom)
        if hit < 0.0 or at + hit >= 1.0:
            return False
        if not of_robots[geom[0]] and _alpha(model, int(geom[0])) >= OPAQUE:
            return True
        at += hit + STEP
    return True


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
    beside = RenderScene(scene.model)
    beside.pose(state)
    return first_view(beside.model, beside.data) or DEFAULT_VIEW


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
