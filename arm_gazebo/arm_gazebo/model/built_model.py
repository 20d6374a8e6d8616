"""A robot in its world, ready to be simulated."""

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.build_report import BuildReport
from arm_gazebo.robot.actuation import RobotJoint


@dataclass(frozen=True, slots=True)
class BuiltModel:
    """The result of `build_world`.

    Attributes:
        model: the compiled model.
        spec: the specification that it was compiled from; None for a model from a file.
        joints: the robot's joints with one degree of freedom, by name, in the URDF's order.
        bodies: ids of the robot's links, by name.
        qpos: starting positions, shape (nq,), read-only.
        report: what was changed, repaired or left out.
        robots: names of each robot's top-level bodies, by robot name.
    """

    model: mujoco.MjModel
    spec: mujoco.MjSpec | None
    joints: Mapping[str, RobotJoint]
    bodies: Mapping[str, int]
    qpos: NDArray[np.float64]
    report: BuildReport
    robots: Mapping[str, tuple[str, ...]]

    @property
    def robot_roots(self) -> frozenset[str]:
        """The top-level bodies of all robots."""
        return frozenset(root for roots in self.robots.values() for root in roots)
