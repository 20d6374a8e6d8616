"""The simulation as a Python library: robots, controllers, worlds and cameras, without ROS.

`Simulation` runs the classes of the simulation node in the calling thread, as fast as possible.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from arm_node.collection import imports_kept
from arm_node.public_names import on_first_use

if TYPE_CHECKING:
    from arm_gazebo.world.contacts import Contact as Contact
    from arm_sim.cameras import Camera as Camera
    from arm_sim.controllers import ControllerHandle as ControllerHandle
    from arm_sim.errors import ArmSimError as ArmSimError
    from arm_sim.errors import CallError as CallError
    from arm_sim.errors import GoalError as GoalError
    from arm_sim.errors import UnknownNameError as UnknownNameError
    from arm_sim.goals import Goal as Goal
    from arm_sim.joints import Joints as Joints
    from arm_sim.joints import JointState as JointState
    from arm_sim.robots import NAMED_ROBOTS as NAMED_ROBOTS
    from arm_sim.robots import NamedRobot as NamedRobot
    from arm_sim.simulation import Simulation as Simulation
    from arm_sim.snapshots import SavedState as SavedState
    from arm_sim.trajectory import JointTrajectory as JointTrajectory

_IMPORT_ENVIRONMENT = {
    # A window library would double MuJoCo's import time.
    "MUJOCO_GL": "disabled",
    # The threads of NumPy's OpenBLAS wait awake before they sleep: for 2^20 cycles, less than a
    # millisecond. By default one of them takes a tenth of the processor time of a start.
    "OPENBLAS_THREAD_TIMEOUT": "20",
}
"""Variables that MuJoCo and NumPy read when they are imported."""

_import_name, __dir__ = on_first_use(__name__)


def __getattr__(name: str) -> Any:
    # Importing all of them takes as long as a start.
    with _import_environment(), imports_kept():
        return _import_name(name)


@contextmanager
def _import_environment() -> Iterator[None]:
    """Set the variables of a quick import, for its time only.

    A program that sets one of them, or imports MuJoCo and NumPy first, makes its own choice.
    """
    added = {name: value for name, value in _IMPORT_ENVIRONMENT.items() if name not in os.environ}
    os.environ.update(added)
    try:
        yield
    finally:
        for name in added:
            os.environ.pop(name, None)
