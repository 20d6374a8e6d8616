"""The simulation as a Python library: robots, controllers, worlds and cameras, without ROS.

`Simulation` runs the classes of the simulation node in the calling thread, as fast as possible.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import TYPE_CHECKING, Any

from arm_node.collection import imports_kept

if TYPE_CHECKING:
    from arm_gazebo.world.contacts import Contact
    from arm_sim.cameras import Camera
    from arm_sim.controllers import ControllerHandle
    from arm_sim.errors import ArmSimError, CallError, GoalError, UnknownNameError
    from arm_sim.goals import Goal
    from arm_sim.joints import Joints, JointState
    from arm_sim.robots import NAMED_ROBOTS, NamedRobot
    from arm_sim.simulation import Simulation
    from arm_sim.snapshots import SavedState
    from arm_sim.trajectory import JointTrajectory

__all__ = [
    "NAMED_ROBOTS",
    "ArmSimError",
    "CallError",
    "Camera",
    "Contact",
    "ControllerHandle",
    "Goal",
    "GoalError",
    "JointState",
    "JointTrajectory",
    "Joints",
    "NamedRobot",
    "SavedState",
    "Simulation",
    "UnknownNameError",
]

MUJOCO_GL = "MUJOCO_GL"

_EXPORTS = {
    "arm_gazebo.world.contacts": ("Contact",),
    "arm_sim.cameras": ("Camera",),
    "arm_sim.controllers": ("ControllerHandle",),
    "arm_sim.errors": ("ArmSimError", "CallError", "GoalError", "UnknownNameError"),
    "arm_sim.goals": ("Goal",),
    "arm_sim.joints": ("JointState", "Joints"),
    "arm_sim.robots": ("NAMED_ROBOTS", "NamedRobot"),
    "arm_sim.simulation": ("Simulation",),
    "arm_sim.snapshots": ("SavedState",),
    "arm_sim.trajectory": ("JointTrajectory",),
}
_MODULE_OF = {name: module for module, names in _EXPORTS.items() for name in names}


def __getattr__(name: str) -> Any:
    # A public name is imported on first use: importing all of them takes as long as a start.
    if name not in _MODULE_OF:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    with _without_window_library(), imports_kept():
        value = getattr(import_module(_MODULE_OF[name]), name)
    globals()[name] = value
    return value


@contextmanager
def _without_window_library() -> Iterator[None]:
    """Keep MuJoCo from loading a window library, which would double its import time.

    The variable is MuJoCo's; a program that imports MuJoCo first makes its own choice.
    """
    if MUJOCO_GL in os.environ:
        yield
        return
    os.environ[MUJOCO_GL] = "disabled"
    try:
        yield
    finally:
        os.environ.pop(MUJOCO_GL, None)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
