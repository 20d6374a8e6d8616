"""The changes to a world since it was built, and the model with these changes applied."""

from collections.abc import Mapping
from dataclasses import field, replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.errors import WorldError
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.physics.state_transfer import StateTransfer
from arm_gazebo.robot.actuation import RobotJoint
from arm_gazebo.world.spawn_model import SpawnModel
from arm_node.frozen import frozen

Matrix = NDArray[np.float64]
ASLEEP_AT_FIRST = mujoco.mjtSleepPolicy.mjSLEEP_INIT


@frozen
class Spawned:
    """A spawned model.

    Attributes:
        name: prefix of its element names, before "::".
        model: the model that was spawned.
        pose: (4, 4) pose of its frame in the world; its root body is at `model.origin` in it.
    """

    name: str
    model: SpawnModel
    pose: Matrix

    @property
    def root(self) -> str:
        """The name of its root body in the world."""
        return f"{self.prefix}{self.model.root}"

    @property
    def prefix(self) -> str:
        """The prefix of every name of the model in the world."""
        return f"{self.name}::"


@frozen
class WorldChanges:
    """Changes to a world, by default none; the original world is not modified.

    Attributes:
        removed: top-level bodies that were deleted.
        spawned: models that were added.
        moved: new poses (4, 4) of static top-level bodies.
    """

    removed: frozenset[str] = frozenset()
    spawned: tuple[Spawned, ...] = ()
    moved: Mapping[str, Matrix] = field(default_factory=dict)

    def with_spawned(self, spawned: Spawned) -> "WorldChanges":
        """Return these changes with another spawned model."""
        return replace(self, spawned=(*self.spawned, spawned))

    def without(self, root: str) -> "WorldChanges":
        """Return these changes without a body, which was spawned or is part of the world."""
        moved = {body: pose for body, pose in self.moved.items() if body != root}
        kept = tuple(spawned for spawned in self.spawned if spawned.root != root)
        if len(kept) < len(self.spawned):
            return replace(self, spawned=kept, moved=moved)
        return replace(self, removed=self.removed | {root}, moved=moved)

    def with_moved(self, root: str, pose: Matrix) -> "WorldChanges":
        """Return these changes with a body moved."""
        return replace(self, moved={**self.moved, root: pose})


NOTHING = WorldChanges()
"""The world as it was built."""


def changed_model(base: BuiltModel, changes: WorldChanges) -> BuiltModel:
    """Return the model of a world with changes; the base's specification is not modified.

    Raises:
        WorldError: the changed world does not compile.
    """
    if base.spec is None:
        raise WorldError("a world from a recording cannot be changed")
    spec = base.spec.copy()
    for name in changes.removed:
        spec.delete(spec.body(name))
    for spawned in changes.spawned:
        _attach(spec, spawned)
    for name, pose in changes.moved.items():
        body = spec.body(name)
        # Frames around it in the MJCF would be applied to the new pose again.
        body.set_frame(spec.worldbody.add_frame())
        _place(body, pose)
    for body in spec.bodies:
        if body.sleep == ASLEEP_AT_FIRST:
            # Its support may be gone, or it may be moving by now.
            body.sleep = mujoco.mjtSleepPolicy.mjSLEEP_AUTO
    try:
        model = spec.compile()
    except (ValueError, mujoco.FatalError) as error:
        reason = " ".join(str(error).split())
        raise WorldError(f"the world does not compile with this change: {reason}") from error
    # Keep the clip planes and the window's view of the original world.
    model.stat.extent = base.model.stat.extent
    model.stat.center = base.model.stat.center
    model.vis.map.znear, model.vis.map.zfar = base.model.vis.map.znear, base.model.vis.map.zfar
    return BuiltModel(
        model,
        spec,
        joints={name: _joint_in(model, joint) for name, joint in base.joints.items()},
        bodies={
            name: int(model.body(base.model.body(body).name).id)
            for name, body in base.bodies.items()
        },
        qpos=_start(base, model),
        report=base.report,
        robots=base.robots,
    )


def quaternion_of(pose: Matrix) -> NDArray[np.float64]:
    """Return MuJoCo's quaternion (w, x, y, z) of a (4, 4) pose."""
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(pose[:3, :3]).ravel())
    return quaternion


def _attach(spec: mujoco.MjSpec, spawned: Spawned) -> None:
    # Attaching removes the body from its own specification.
    model = spawned.model.spec.copy()
    frame = spec.worldbody.add_frame()
    body = frame.attach_body(model.body(spawned.model.root), spawned.prefix, "")
    _place(body, spawned.pose @ spawned.model.origin)


def _place(body: mujoco.MjsBody, pose: Matrix) -> None:
    body.pos = pose[:3, 3]
    body.quat = quaternion_of(pose)
    body.alt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT


def _joint_in(model: mujoco.MjModel, joint: RobotJoint) -> RobotJoint:
    """Return a robot joint with its indices in another model."""
    found = model.joint(joint.name)
    return replace(
        joint,
        qpos_address=int(found.qposadr[0]),
        dof_address=int(found.dofadr[0]),
        actuator=None if joint.actuator is None else int(model.actuator(joint.name).id),
    )


def _start(base: BuiltModel, model: mujoco.MjModel) -> NDArray[np.float64]:
    """Return the starting positions: robots as before, new entities at their poses."""
    qpos = model.qpos0.copy()
    StateTransfer(base.model, model, base.robot_roots).carry_positions(base.qpos, qpos)
    qpos.setflags(write=False)
    return qpos
