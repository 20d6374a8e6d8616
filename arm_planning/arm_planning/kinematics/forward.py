"""Forward kinematics: the poses of a robot's links for positions of its joints."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_node.names import listing
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.kinematic_tree import kinematic_tree, position_map
from arm_planning.robot.model import JointPositions, PlanningModel

Array = NDArray[np.float64]


class ForwardKinematics:
    """The poses of all links in the root link's frame. For one thread at a time.

    Args:
        model: the robot.
        group: name of the group whose joints vary; "" for all active joints of the model.
        positions: positions of the other joints; 0 for those not named.

    Raises:
        PlanningError: INVALID_GROUP_NAME: there is no such group.
    """

    def __init__(
        self, model: PlanningModel, group: str = "", positions: JointPositions | None = None
    ) -> None:
        self.joints = model.group(group).joints if group else model.joints
        tree = kinematic_tree(model.robot)
        self._map = position_map(model.robot, tuple(tree.joints), self.joints, positions or {})
        self._model = tree.spec.compile()
        self._data = mujoco.MjData(self._model)
        self._body = {link: body.id for link, body in tree.bodies.items()}
        self._address = np.array(
            [self._model.jnt_qposadr[joint.id] for joint in tree.joints.values()], dtype=int
        )

    def pose(self, q: Array, link: str) -> Array:
        """Return a link's pose, (4, 4), for positions of `joints`, (n,).

        Raises:
            PlanningError: INVALID_LINK_NAME: there is no such link.
        """
        if link not in self._body:
            raise PlanningError(
                MoveItErrorCode.INVALID_LINK_NAME,
                f"no link '{link}'; the robot has {listing(self._body)}",
            )
        self._place(q)
        return self._pose_of(self._body[link])

    def poses(self, q: Array) -> dict[str, Array]:
        """Return the poses of all links, (4, 4) each, for positions of `joints`, (n,)."""
        self._place(q)
        return {link: self._pose_of(body) for link, body in self._body.items()}

    def _place(self, q: Array) -> None:
        self._data.qpos[self._address] = self._map(np.asarray(q, dtype=float))
        mujoco.mj_kinematics(self._model, self._data)

    def _pose_of(self, body: int) -> Array:
        result = np.eye(4)
        result[:3, :3] = self._data.xmat[body].reshape(3, 3)
        result[:3, 3] = self._data.xpos[body]
        return result


def as_rigid_transform(matrix: Array) -> RigidTransform:
    """Return the pose of a homogeneous transform, (4, 4)."""
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(matrix[:3, :3]).ravel())
    w, x, y, z = quaternion.tolist()
    px, py, pz = matrix[:3, 3].tolist()
    return RigidTransform((px, py, pz), (x, y, z, w))
