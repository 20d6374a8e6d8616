"""The collision check of a robot in a scene."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from math import inf

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_node.names import describe_known
from arm_node.rigid_transform import Vector
from arm_planning.collision.constant_contacts import GeomContact, constant_contacts
from arm_planning.collision.contact import BodyKind, Contact
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.collision.specification import Body, SceneCompiler
from arm_planning.errors import ErrorCode, PlanningError
from arm_planning.robot.model import JointPositions, PlanningModel
from arm_planning.scene.scene import PlanningScene

Array = NDArray[np.float64]

ORDER = {BodyKind.ROBOT_LINK: 0, BodyKind.ROBOT_ATTACHED: 1, BodyKind.WORLD_OBJECT: 2}


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
    ) -> None:
        self._planning_model = model
        self._scene = scene
        self._group = group
        self._meshes = meshes or MeshPieces()
        self._joints = model.joints if group is None else model.group(group).joints
        compiled = SceneCompiler(model, scene, self._joints, self._meshes).compile()
        self._model, self._bodies = compiled.model, compiled.bodies
        self._links = compiled.links
        self._data = mujoco.MjData(self._model)
        self._qpos = self._data.qpos
        self._coordinates = compiled.coordinates
        self._direct = bool(
            np.array_equal(self._coordinates.matrix, np.eye(len(self._joints)))
            and not self._coordinates.constant.any()
        )
        self._constant = self._constant_contacts()

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints that vary, in the order of the states' coordinates."""
        return self._joints

    def is_free(self, q: Array) -> bool:
        """Return whether nothing collides.

        Args:
            q: the positions of `joints`, (n,), rad or m.

        Raises:
            PlanningError: a position is not finite.
        """
        if self._constant:
            return False
        self._place(q)
        mujoco.mj_collision(self._model, self._data)
        return self._data.ncon == 0

    def contacts(self, q: Array) -> tuple[Contact, ...]:
        """Return the deepest contact of each pair that collides, the deepest first.

        Args:
            q: the positions of `joints`, (n,).

        Raises:
            PlanningError: a position is not finite.
        """
        self._place(q)
        mujoco.mj_collision(self._model, self._data)
        return _deepest([*self._found(), *self._constant])

    def link_pose(self, q: Array, link: str) -> Array:
        """Return the pose of a link in the planning frame, (4, 4).

        Args:
            q: the positions of `joints`, (n,).
            link: its name.

        Raises:
            PlanningError: there is no such link, or a position is not finite.
        """
        if link not in self._links:
            raise PlanningError(
                ErrorCode.INVALID_LINK_NAME,
                f"no link '{link}'; {describe_known(link, self._links, 'the robot has')}",
            )
        self._place(q)
        pose = np.eye(4)
        pose[:3, :3] = self._data.xmat[self._links[link]].reshape(3, 3)
        pose[:3, 3] = self._data.xpos[self._links[link]]
        return pose

    def with_positions(self, positions: JointPositions) -> "CollisionModel":
        """Return the model of the scene with other positions; joints not named keep theirs."""
        scene = replace(self._scene, positions={**self._scene.positions, **positions})
        return CollisionModel(self._planning_model, scene, self._group, self._meshes)

    def _place(self, q: Array) -> None:
        if self._direct:
            self._qpos[:] = q
        else:
            self._qpos[:] = self._coordinates(q)
        # MuJoCo finds no contact at all where a number is not finite.
        if not self._qpos.dot(self._qpos) < inf:
            raise PlanningError(
                ErrorCode.INVALID_ROBOT_STATE, f"a state has positions that are not finite: {q}"
            )
        mujoco.mj_kinematics(self._model, self._data)

    def _constant_contacts(self) -> tuple[Contact, ...]:
        self._place(np.zeros(len(self._joints)))
        asked = np.array([self._is_checked(body) for body in self._bodies])
        return _deepest(map(self._contact, constant_contacts(self._model, self._data, asked)))

    def _is_checked(self, body: Body | None) -> bool:
        """Return whether a body is checked against all others, moving or not."""
        if body is None or body.kind is BodyKind.WORLD_OBJECT:
            return False
        return self._group is None or body.moves

    def _found(self) -> Iterator[Contact]:
        """Yield the contacts that MuJoCo found."""
        found = self._data.contact
        for (first, second), distance, position, frame in zip(
            found.geom.tolist(), found.dist.tolist(), found.pos, found.frame, strict=True
        ):
            yield self._contact(GeomContact(first, second, distance, position, frame[:3]))

    def _contact(self, found: GeomContact) -> Contact:
        """Name the bodies: links before what is attached, that before objects, then by name."""
        first, second, normal = (
            self._body_of(found.first),
            self._body_of(found.second),
            found.normal,
        )
        if (ORDER[first.kind], first.name) > (ORDER[second.kind], second.name):
            first, second, normal = second, first, -normal
        return Contact(
            first.name,
            second.name,
            first.kind,
            second.kind,
            -found.distance,
            _vector(found.position),
            _vector(normal),
        )

    def _body_of(self, geom: int) -> Body:
        body = self._bodies[self._model.geom_bodyid[geom]]
        assert body is not None
        return body


def _deepest(contacts: Iterable[Contact]) -> tuple[Contact, ...]:
    """Return the deepest contact of each pair, the deepest first."""
    found: dict[tuple[str, str, BodyKind], Contact] = {}
    for contact in contacts:
        pair = (contact.first, contact.second, contact.second_kind)
        if pair not in found or found[pair].depth_m < contact.depth_m:
            found[pair] = contact
    return tuple(sorted(found.values(), key=lambda contact: -contact.depth_m))


def _vector(values: Array) -> Vector:
    x, y, z = values.tolist()
    return (x, y, z)
