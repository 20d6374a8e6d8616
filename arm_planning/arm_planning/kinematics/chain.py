"""The joints between the root and a link, placed one state at a time.

MuJoCo computes poses and Jacobians of a chain of six joints in 1.5 us, and a whole step of a
descent takes 10. In NumPy a step takes 84 us, and 112 us for sixteen starts at once, which is no
gain either: most searches need two starts.
"""

import math
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.urdf.robot import Robot
from arm_planning.kinematic_tree import kinematic_tree, position_map
from arm_planning.robot.model import JointPositions

Array = NDArray[np.float64]

REACH_MARGIN = 1e-6
"""A place that is out of reach by less than this share counts as at the end of the reach."""


class Chain:
    """A link and the varying joints that carry it.

    For one thread at a time: a state is placed, then asked about.

    Args:
        robot: the robot.
        tip: name of the link.
        joints: names of the joints that vary, in the order of all arrays.
        positions: positions of all other joints; one without a position is at 0.

    Attributes:
        others: the joints beside the varying ones that the tip's pose depends on.
        moving: for each joint whether it moves the tip, itself or through a mimic joint, (n,).
        position: the placed tip's position, in m, (3,); overwritten by the next `place`.
        quaternion: its rotation as w, x, y, z, (4,); likewise.
        anchor: where the first joint stands, in m, (3,).
        reach_m: the tip gets no farther from the anchor, if no joint slides.
        slides: whether a joint slides.
    """

    def __init__(
        self, robot: Robot, tip: str, joints: Sequence[str], positions: JointPositions
    ) -> None:
        tree = kinematic_tree(robot, (tip,))
        carrying = tuple(tree.joints)
        self._map = position_map(robot, carrying, joints, positions)
        leaders = (robot.leader_of(name, {*joints, *positions}).joint for name in carrying)
        self.others = tuple(name for name in dict.fromkeys(leaders) if name not in joints)
        self.moving = self._map.matrix.any(axis=0)
        # Without other joints and mimic joints in between, the model's joints are the given ones.
        self._direct = self._map.is_identity
        self._model = tree.spec.compile()
        self._data = mujoco.MjData(self._model)
        self._body = tree.bodies[tip].id
        self._qpos = self._data.qpos
        self.position: Array = self._data.xpos[self._body]
        self.quaternion: Array = self._data.xquat[self._body]
        self._jacobian = np.zeros((6, len(carrying)))
        self._linear, self._angular = self._jacobian[:3], self._jacobian[3:]
        self.slides = any(robot.joint(name).type.slides for name in carrying)
        self.place(np.zeros(len(joints)))
        points = np.vstack([self._data.xanchor, self.position])
        self.anchor: Array = points[0]
        self.reach_m = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())

    def place(self, q: Array) -> None:
        """Compute the tip's pose for positions of the joints, (n,)."""
        self._qpos[:] = q if self._direct else self._map(q)
        mujoco.mj_kinematics(self._model, self._data)

    def jacobian(self) -> Array:
        """Return how the placed tip moves with the joints, (6, n).

        Three rows of velocity and three of angular velocity, in the root's frame, for each joint's
        speed of 1 rad/s or m/s. The array may be overwritten by the next call.
        """
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_jacBody(self._model, self._data, self._linear, self._angular, self._body)
        return self._jacobian if self._direct else self._jacobian @ self._map.matrix

    def pose(self, q: Array) -> Array:
        """Return the tip's pose in the root's frame for positions of the joints, (4, 4)."""
        self.place(q)
        result = np.eye(4)
        result[:3, :3] = self._data.xmat[self._body].reshape(3, 3)
        result[:3, 3] = self.position
        return result

    def turns_freely(self, joint: int) -> bool:
        """Whether a full turn of a turning joint brings the tip back to its pose."""
        column = self._map.matrix[:, joint]
        return bool((column == np.rint(column)).all())

    def is_too_short_for(self, position: Array) -> bool:
        """Whether a place, (3,), is certainly out of reach, whatever the joints' limits."""
        distance = math.dist(position, self.anchor)
        return not self.slides and distance > self.reach_m * (1.0 + REACH_MARGIN)
