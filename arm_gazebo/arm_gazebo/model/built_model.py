"""A robot in its world, ready to be simulated."""

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.build_report import BuildReport
from arm_gazebo.robot.joint import RobotJoint


@dataclass(frozen=True, slots=True)
class BuiltModel:
    """What `build_model` makes.

    Attributes:
        model: the compiled model.
        spec: what it was compiled from.
        joints: the robot's joints with one degree of freedom, by name, in the URDF's order.
        bodies: ids of the robot's links, by name.
        qpos: positions at the start, shape (nq,), read-only.
        report: what was changed, repaired or left out.
        robots: names of the bodies right below the world that each robot consists of, by robot.
    """

    model: mujoco.MjModel
    spec: mujoco.MjSpec
    joints: Mapping[str, RobotJoint]
    bodies: Mapping[str, int]
    qpos: NDArray[np.float64]
    report: BuildReport
    robots: Mapping[str, tuple[str, ...]]

    @property
    def robot_roots(self) -> frozenset[str]:
        """The bodies right below the world that are robots'."""
        return frozenset(root for roots in self.robots.values() for root in roots)
