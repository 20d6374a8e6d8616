"""Inverse kinematics: joint positions that bring a link to a target pose.

Damped least squares with the geometric Jacobian (Nakamura and Hanafusa 1986; Wampler 1986): each
step is J^T (J J^T + d^2)^-1 e, which stays small near a singular pose.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import KinematicsError
from arm_description.kinematics.forward import forward_kinematics
from arm_description.urdf.robot import Joint, Robot
from arm_node.names import listing

Array = NDArray[np.float64]

REACH_M = 0.1
"""Length that one radian of error is equivalent to."""
DAMPING = 0.02
"""Damping of J J^T, in m; smaller errors in a singular direction are not corrected."""
MAX_STEP = 0.2
"""Largest step of a joint in one iteration, rad or m: beyond it the Jacobian is not valid."""
ITERATIONS = 200
PATIENCE = 25
"""Iterations without an improvement of 10 %, after which the search gives up."""
HALF_TURN = 1e-6
"""Sine of an angle below which it counts as half a turn."""
WITHIN_M, WITHIN_RAD = 1e-5, 1e-4


class InverseKinematics:
    """Finds positions of some joints of a robot; others stay at 0, mimic joints follow.

    Args:
        robot: the robot.
        link: name of the link to place.
        joints: names of the joints that move it, in the order of all arrays.

    Raises:
        UrdfError: the link or a joint does not exist.
        KinematicsError: a joint does not move the link, or its position is not one number.
    """

    def __init__(self, robot: Robot, link: str, joints: Sequence[str]) -> None:
        self._robot = robot
        self._link = robot.link(link).name
        self._joints = tuple(robot.joint(name) for name in joints)
        above = _joints_above(robot, link)
        for joint in self._joints:
            if joint.name not in above:
                raise KinematicsError(
                    f"joint '{joint.name}' does not move link '{link}'; these do: {listing(above)}"
                )
            if not joint.type.is_scalar:
                raise KinematicsError(
                    f"joint '{joint.name}' is {joint.type}: its position is not a single number"
                )
        ranges = np.array([_range(joint) for joint in self._joints]).reshape(-1, 2)
        self._lower, self._upper = ranges.T

    def pose(self, positions: Sequence[float] | Array) -> Array:
        """Return the link's pose in the root's frame as a (4, 4) transform."""
        return self._poses(positions)[self._link]

    def solve(self, target: Array, start: Sequence[float] | Array) -> Array:
        """Return positions within the joints' limits that bring the link to a pose, shape (n,).

        Args:
            target: pose in the root link's frame, (4, 4).
            start: start of the search, (n,). Of several solutions, one near it is found; from far
                away, it may find none.

        Raises:
            KinematicsError: no solution was found; the message says how close the best one comes.
        """
        q = np.clip(np.asarray(start, dtype=float), self._lower, self._upper)
        nearest, best, progress = q, math.inf, 0
        for iteration in range(ITERATIONS):
            poses = self._poses(q)
            error = _difference(target, poses[self._link])
            if _is_there(error):
                return q
            if (size := _size(error)) < 0.9 * best:
                nearest, best, progress = q, size, iteration
            elif iteration - progress > PATIENCE:
                break
            q = np.clip(q + self._step(poses, error), self._lower, self._upper)
        raise KinematicsError(self._out_of_reach(target, nearest))

    def _poses(self, positions: Sequence[float] | Array) -> dict[str, Array]:
        names = (joint.name for joint in self._joints)
        return forward_kinematics(
            self._robot, dict(zip(names, np.asarray(positions).tolist(), strict=True))
        )

    def _step(self, poses: dict[str, Array], error: Array) -> Array:
        jacobian = np.column_stack([_column(joint, poses, self._link) for joint in self._joints])
        # All rows in metres, so that one damping suits them all.
        scale = np.repeat((1.0, REACH_M), 3)
        jacobian, error = jacobian * scale[:, None], error * scale
        # The damping decreases close to the target, so that the last steps are full ones.
        damping = DAMPING**2 * min(1.0, float(np.linalg.norm(error)) / REACH_M)
        damped = jacobian @ jacobian.T + damping * np.eye(6)
        step = jacobian.T @ np.linalg.lstsq(damped, error, rcond=None)[0]
        largest = float(np.abs(step).max(initial=0.0))
        return step * min(1.0, MAX_STEP / largest) if largest else step

    def _out_of_reach(self, target: Array, nearest: Array) -> str:
        error = _difference(target, self.pose(nearest))
        x, y, z = target[:3, 3]
        return (
            f"link '{self._link}' cannot reach ({x:.3f}, {y:.3f}, {z:.3f}) m in the given "
            f"orientation: the best pose is off by {np.linalg.norm(error[:3]) * 1e3:.2g} mm and "
            f"{math.degrees(np.linalg.norm(error[3:])):.2g} degrees"
        )


def _joints_above(robot: Robot, link: str) -> tuple[str, ...]:
    """Return the joints between the root and a link, starting at the root."""
    by_child = {joint.child: joint for joint in robot.joints}
    found: list[str] = []
    while link in by_child:
        found.append(by_child[link].name)
        link = by_child[link].parent
    return tuple(reversed(found))


def _range(joint: Joint) -> tuple[float, float]:
    limit = joint.limit
    return (limit.lower, limit.upper) if limit is not None else (-math.inf, math.inf)


def _column(joint: Joint, poses: dict[str, Array], link: str) -> Array:
    """Return a joint's column of the Jacobian: linear and angular velocity, shape (6,)."""
    # The child's frame rotates about the axis, so the axis is the same in both frames.
    frame = poses[joint.child]
    axis = frame[:3, :3] @ joint.axis
    if joint.type.turns:
        return np.concatenate([np.cross(axis, poses[link][:3, 3] - frame[:3, 3]), axis])
    return np.concatenate([axis, np.zeros(3)])


def _difference(target: Array, pose: Array) -> Array:
    """Return the translation (m) and the rotation vector (rad) from a pose to a target, (6,)."""
    turn = target[:3, :3] @ pose[:3, :3].T
    axis = 0.5 * np.array(
        [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
    )
    sine, cosine = float(np.linalg.norm(axis)), 0.5 * float(np.trace(turn) - 1.0)
    if sine < HALF_TURN and cosine < 0.0:
        # R + 1 is 2 a a^T here, so its columns are parallel to the axis; the sign is arbitrary.
        columns = turn + np.eye(3)
        axis = columns[:, np.linalg.norm(columns, axis=0).argmax()]
    length = float(np.linalg.norm(axis))
    vector = math.atan2(sine, cosine) / length * axis if length else axis
    return np.concatenate([target[:3, 3] - pose[:3, 3], vector])


def _size(error: Array) -> float:
    return float(np.linalg.norm(error[:3]) + REACH_M * np.linalg.norm(error[3:]))


def _is_there(error: Array) -> bool:
    return bool(np.linalg.norm(error[:3]) < WITHIN_M and np.linalg.norm(error[3:]) < WITHIN_RAD)
