"""Compute poses and velocities of entities from a copy of the simulation's state."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.physics.state_probe import WorldState
from arm_gazebo.world.changes import Matrix
from arm_gazebo.world.entity import WorldEntity

Vector = NDArray[np.float64]
Box = NDArray[np.float64]
PLANE = mujoco.mjtGeom.mjGEOM_PLANE


@dataclass(frozen=True, slots=True)
class EntityMotion:
    """Pose and velocity of a frame in the world, at one time.

    Attributes:
        time_s: simulation time.
        pose: (4, 4).
        linear: velocity of the origin, m/s, shape (3,).
        angular: velocity about the world's axes, rad/s, shape (3,).
    """

    time_s: float
    pose: Matrix
    linear: Vector
    angular: Vector


class EntityMotions:
    """Computes on its own copy of the state and never touches the running simulation. One thread.

    Args:
        model: the model, which is not modified.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._data = mujoco.MjData(model)
        self._time_s = 0.0

    def take(self, state: WorldState) -> None:
        """Use this state of the same model from now on."""
        data = self._data
        self._time_s = state.time_s
        data.qpos[:], data.qvel[:] = state.qpos, state.qvel
        data.mocap_pos[:], data.mocap_quat[:] = state.mocap_pos, state.mocap_quat
        mujoco.mj_kinematics(self._model, data)
        mujoco.mj_comPos(self._model, data)
        mujoco.mj_comVel(self._model, data)

    @property
    def geom_poses(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Positions (ngeom, 3) and rotations (ngeom, 9) of all shapes in the world."""
        return self._data.geom_xpos, self._data.geom_xmat

    def of(self, entity: WorldEntity) -> EntityMotion:
        """Return the motion of an entity's frame."""
        root = self.motion(entity.roots[0])
        pose = root.pose @ np.linalg.inv(entity.origin)
        linear = root.linear + np.cross(root.angular, pose[:3, 3] - root.pose[:3, 3])
        return EntityMotion(root.time_s, pose, linear, root.angular)

    def motion(self, body: str) -> EntityMotion:
        """Return the motion of a body's frame."""
        index = self._model.body(body).id
        velocity = np.zeros(6)
        mujoco.mj_objectVelocity(
            self._model, self._data, mujoco.mjtObj.mjOBJ_XBODY, index, velocity, 0
        )
        return EntityMotion(self._time_s, self.pose(body), velocity[3:], velocity[:3])

    def pose(self, body: str) -> Matrix:
        """Return the pose (4, 4) of a body's frame in the world."""
        index = self._model.body(body).id
        pose = np.eye(4)
        pose[:3, :3] = self._data.xmat[index].reshape(3, 3)
        pose[:3, 3] = self._data.xpos[index]
        return pose

    def bounds(self, entity: WorldEntity, frame: Matrix | None = None) -> Box | None:
        """Return the bounding box of an entity's shapes; None if it has no shapes.

        Args:
            entity: the entity.
            frame: pose (4, 4) of the frame that the box is aligned to; by default the world.

        Returns:
            Lowest and highest corner in that frame, shape (2, 3).
        """
        model, data = self._model, self._data
        inverse = np.eye(4) if frame is None else np.linalg.inv(frame)
        roots = [model.body(root).id for root in entity.roots]
        own = np.isin(model.body_rootid[model.geom_bodyid], roots) & (model.geom_type != PLANE)
        corners = [
            inverse[:3, :3] @ (data.geom_xpos[geom] + data.geom_xmat[geom].reshape(3, 3) @ corner)
            + inverse[:3, 3]
            for geom in np.flatnonzero(own).tolist()
            for corner in _corners(model.geom_aabb[geom])
        ]
        return np.array([np.min(corners, axis=0), np.max(corners, axis=0)]) if corners else None


def _corners(box: NDArray[np.float64]) -> list[Vector]:
    """Return the corners of MuJoCo's bounding box, which is given by centre and half sides."""
    return [box[:3] + np.where(choice, box[3:], -box[3:]) for choice in np.ndindex(2, 2, 2)]
