"""What was changed in a world since it was built, and the model of both together."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.errors import WorldError
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.physics.state_transfer import StateTransfer
from arm_gazebo.robot.joint import RobotJoint
from arm_gazebo.world.spawn_model import SpawnModel

Matrix = NDArray[np.float64]
ASLEEP_AT_FIRST = mujoco.mjtSleepPolicy.mjSLEEP_INIT


@dataclass(frozen=True, slots=True)
class Spawned:
    """A model that was put into the world.

    Attributes:
        name: before "::" in the names of all that is in it.
        model: what it is made of.
        pose: (4, 4) of its frame in the world, in which its root body is at `model.origin`.
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
        """What stands before every name of the model in the world."""
        return f"{self.name}::"


@dataclass(frozen=True, slots=True)
class WorldChanges:
    """Changes of a world, none by default; the world itself stays as it is.

    Attributes:
        removed: bodies right below the world that were deleted.
        spawned: models that were added.
        moved: new poses (4, 4) of bodies right below the world that cannot move by themselves.
    """

    removed: frozenset[str] = frozenset()
    spawned: tuple[Spawned, ...] = ()
    moved: Mapping[str, Matrix] = field(default_factory=dict)

    def with_spawned(self, spawned: Spawned) -> "WorldChanges":
        """Return these changes and a model more."""
        return replace(self, spawned=(*self.spawned, spawned))

    def without(self, root: str) -> "WorldChanges":
        """Return these changes and a body less, spawned or the world's own."""
        moved = {body: pose for body, pose in self.moved.items() if body != root}
        kept = tuple(spawned for spawned in self.spawned if spawned.root != root)
        if len(kept) < len(self.spawned):
            return replace(self, spawned=kept, moved=moved)
        return replace(self, removed=self.removed | {root}, moved=moved)

    def with_moved(self, root: str, pose: Matrix) -> "WorldChanges":
        """Return these changes with a body elsewhere."""
        return replace(self, moved={**self.moved, root: pose})


def changed_model(base: BuiltModel, changes: WorldChanges) -> BuiltModel:
    """Return the model of a world with changes; the base's own specification stays as it is.

    Raises:
        WorldError: both together do not compile.
    """
    spec = base.spec.copy()
    for name in changes.removed:
        spec.delete(spec.body(name))
    for spawned in changes.spawned:
        _attach(spec, spawned)
    for name, pose in changes.moved.items():
        body = spec.body(name)
        # Frames of an MJCF around it would move it once more.
        body.set_frame(spec.worldbody.add_frame())
        _place(body, pose)
    for body in spec.bodies:
        if body.sleep == ASLEEP_AT_FIRST:
            # It may have lost what it lay on, or be under way by now.
            body.sleep = mujoco.mjtSleepPolicy.mjSLEEP_AUTO
    try:
        model = spec.compile()
    except (ValueError, mujoco.FatalError) as error:
        reason = " ".join(str(error).split())
        raise WorldError(f"the world does not compile with this change: {reason}") from error
    # Pictures are clipped, and windows opened, as in the world of the start.
    model.stat.extent = base.model.stat.extent
    model.stat.center = base.model.stat.center
    model.vis.map.znear, model.vis.map.zfar = base.model.vis.map.znear, base.model.vis.map.zfar
    return BuiltModel(
        model,
        spec,
        joints={name: _found_again(joint, model) for name, joint in base.joints.items()},
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
    # Attaching takes the body out of where it was.
    model = spawned.model.spec.copy()
    frame = spec.worldbody.add_frame()
    body = frame.attach_body(model.body(spawned.model.root), spawned.prefix, "")
    _place(body, spawned.pose @ spawned.model.origin)


def _place(body: mujoco.MjsBody, pose: Matrix) -> None:
    body.pos = pose[:3, 3]
    body.quat = quaternion_of(pose)
    body.alt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT


def _found_again(joint: RobotJoint, model: mujoco.MjModel) -> RobotJoint:
    """Return a joint of the robot at its place in another model."""
    found = model.joint(joint.name)
    return replace(
        joint,
        qpos_address=int(found.qposadr[0]),
        dof_address=int(found.dofadr[0]),
        actuator=None if joint.actuator is None else int(model.actuator(joint.name).id),
    )


def _start(base: BuiltModel, model: mujoco.MjModel) -> NDArray[np.float64]:
    """Return where everything starts: the robots as before, what is new at its pose."""
    qpos = model.qpos0.copy()
    StateTransfer(base.model, model, base.robot_roots).carry_positions(base.qpos, qpos)
    qpos.setflags(write=False)
    return qpos
