"""The collision check of a robot in a scene."""

from math import inf

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_node.names import describe_known
from arm_planning.collision.contact import BodyKind, CollisionContact
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.collision.posed_scene import PosedScene, deepest
from arm_planning.collision.specification import CollisionBody, CompiledScene, SceneCompiler
from arm_planning.errors import InvalidLinkError
from arm_planning.robot.model import PlanningModel
from arm_planning.scene.scene import PlanningScene

Array = NDArray[np.float64]


class CollisionModel:
    """Tells which states of a robot collide, with itself or with the objects of a scene.

    Only shapes for collisions count: a link without them touches nothing. Links are padded and
    scaled against the world, not against each other. Objects do not collide with each other.

    With a group, its joints vary and all others stay at their positions in the scene. What no joint
    of the group moves is not checked against other such bodies, as in MoveIt: a table may overlap
    the robot's base. Without a group all active joints vary and everything is checked.

    The values come from MuJoCo; shapes that just touch do not collide. A mesh of an object that is
    not convex is a surface: see `mesh_pieces`.

    Not thread-safe: one thread at a time.

    Args:
        model: the robot.
        scene: its surroundings, and the positions of its joints.
        group: name of the group that moves.
        meshes: cuts meshes; pass the same to all models of a robot, because it remembers them.
        like: a model of the same robot and group in another scene: what is the same is taken over,
            which is faster. It stays as it is.

    Raises:
        PlanningError: there is no such group, a shape or a mesh cannot be used, or a body is
            attached to a link that does not exist.
    """

    def __init__(
        self,
        model: PlanningModel,
        scene: PlanningScene,
        group: str | None = None,
        meshes: MeshPieces | None = None,
        like: "CollisionModel | None" = None,
    ) -> None:
        self._planning_model = model
        self._group = group
        self._joints = model.joints if group is None else model.group(group).joints
        known = None if like is None else like.compiled
        compiler = SceneCompiler(model, scene, self._joints, meshes or MeshPieces(), known)
        self._compiled = compiler.compile()
        self._posed = PosedScene(self._compiled)
        self._model, self._data = self._posed.model, self._posed.data
        self._constant = self._constant_contacts()
        self._posed.leave_out_apart()

    @property
    def constant_contacts(self) -> tuple[CollisionContact, ...]:
        """What collides in every state, the deepest first."""
        return self._constant

    @property
    def compiled(self) -> CompiledScene:
        """What MuJoCo compiled."""
        return self._compiled

    @property
    def posed(self) -> PosedScene:
        """The compiled scene; all its margins are 0 but while a motion is proved."""
        return self._posed

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints that vary, in the order of the states' coordinates."""
        return self._joints

    def limits(self, joint: str) -> tuple[float, float]:
        """Return the lower and upper limit of a joint in the URDF, in rad or m."""
        limit = self._planning_model.robot.joint(joint).limit
        return (-inf, inf) if limit is None else (limit.lower, limit.upper)

    def is_free(self, q: Array) -> bool:
        """Return whether nothing collides.

        Args:
            q: the positions of `joints`, (n,), rad or m.

        Raises:
            PlanningError: a position is not finite.
        """
        if self._constant:
            return False
        self._posed.place(q)
        mujoco.mj_collision(self._model, self._data)
        return self._data.ncon == 0

    def free_count(self, states: Array, clearance_m: float = 0.0) -> int:
        """Return how many states are free before the first that collides; all if none does.

        Args:
            states: positions of `joints`, (k, n), in the order in which they are looked at.
            clearance_m: distance from which on two bodies collide.

        Raises:
            PlanningError: a position is not finite.
        """
        return 0 if self._constant else self._posed.free_count(states, clearance_m)

    def contacts(self, q: Array) -> tuple[CollisionContact, ...]:
        """Return the deepest contact of each pair that collides, the deepest first.

        Args:
            q: the positions of `joints`, (n,).

        Raises:
            PlanningError: a position is not finite.
        """
        self._posed.place(q)
        mujoco.mj_collision(self._model, self._data)
        return deepest([*self._posed.found(), *self._constant])

    def link_pose(self, q: Array, link: str) -> Array:
        """Return the pose of a link in the planning frame, (4, 4).

        Args:
            q: the positions of `joints`, (n,).
            link: its name.

        Raises:
            PlanningError: there is no such link, or a position is not finite.
        """
        if link not in self._posed.links:
            raise InvalidLinkError(
                f"no link '{link}'; {describe_known(link, self._posed.links, 'the robot has')}"
            )
        self._posed.place(q)
        pose = np.eye(4)
        pose[:3, :3] = self._data.xmat[self._posed.links[link]].reshape(3, 3)
        pose[:3, 3] = self._data.xpos[self._posed.links[link]]
        return pose

    def _constant_contacts(self) -> tuple[CollisionContact, ...]:
        self._posed.place(np.zeros(len(self._joints)))
        asked = np.array([self._is_checked(body) for body in self._posed.bodies])
        return deepest(self._posed.constant_contacts(asked))

    def _is_checked(self, body: CollisionBody | None) -> bool:
        """Return whether a body is checked against all others, moving or not."""
        if body is None or body.kind is BodyKind.WORLD_OBJECT:
            return False
        return self._group is None or body.moves
