"""Where entities are and how they move, computed from a copy of the simulation's state."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.physics.world_state import WorldState
from arm_gazebo.world.changes import Matrix
from arm_gazebo.world.entity import Entity

Vector = NDArray[np.float64]
Box = NDArray[np.float64]
PLANE = mujoco.mjtGeom.mjGEOM_PLANE


@dataclass(frozen=True, slots=True)
class Motion:
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
    """Computes on a state of its own: nothing here touches the running simulation. One thread.

    Args:
        model: is only read.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._data = mujoco.MjData(model)
        self._time_s = 0.0

    def take(self, state: WorldState) -> None:
        """Go by this state of the same model from now on."""
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

    def of(self, entity: Entity) -> Motion:
        """Return the motion of an entity's frame; of its first root, where they are the same."""
        root = self.motion(entity.roots[0])
        pose = root.pose @ np.linalg.inv(entity.origin)
        linear = root.linear + np.cross(root.angular, pose[:3, 3] - root.pose[:3, 3])
        return Motion(root.time_s, pose, linear, root.angular)

    def motion(self, body: str) -> Motion:
        """Return the motion of a body's frame."""
        index = self._model.body(body).id
        velocity = np.zeros(6)
        mujoco.mj_objectVelocity(
            self._model, self._data, mujoco.mjtObj.mjOBJ_XBODY, index, velocity, 0
        )
        return Motion(self._time_s, self.pose(body), velocity[3:], velocity[:3])

    def pose(self, body: str) -> Matrix:
        """Return the pose (4, 4) of a body's frame in the world."""
        index = self._model.body(body).id
        pose = np.eye(4)
        pose[:3, :3] = self._data.xmat[index].reshape(3, 3)
        pose[:3, 3] = self._data.xpos[index]
        return pose

    def bounds(self, entity: Entity, frame: Matrix | None = None) -> Box | None:
        """Return the box around an entity's shapes, None where it has none.

        Args:
            entity: whose.
            frame: pose (4, 4) of the frame whose axes the box follows; the world's by default.

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
    """Return the corners of MuJoCo's box of a shape: its middle and half sides."""
    return [box[:3] + np.where(choice, box[3:], -box[3:]) for choice in np.ndindex(2, 2, 2)]
