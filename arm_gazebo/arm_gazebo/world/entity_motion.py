"""Poses and velocities of entities in a copy of the simulation's state, and filters by them."""

import mujoco
import numpy as np
import re2
from numpy.typing import NDArray

from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.physics.state_probe import WorldState, evaluate_all
from arm_gazebo.world.changes import Matrix
from arm_gazebo.world.entity import Category, Entities, WorldEntity
from arm_node.frozen import frozen

Vector = NDArray[np.float64]
Box = NDArray[np.float64]
PLANE = mujoco.mjtGeom.mjGEOM_PLANE


@frozen
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

    But for `take`, which belongs to the thread that steps the model.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._data = mujoco.MjData(model)
        self._time_s = 0.0

    def take(self, state: WorldState) -> None:
        """Use this state of the same model from now on. The model's thread, between two steps."""
        data = self._data
        self._time_s = state.time_s
        data.qpos[:], data.qvel[:] = state.qpos, state.qvel
        data.mocap_pos[:], data.mocap_quat[:] = state.mocap_pos, state.mocap_quat
        steps = mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_comVel
        evaluate_all(self._model, data, *steps)

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


MAX_PATTERN_LENGTH = 200


class NamePattern:
    """A POSIX extended regular expression; the escapes of `re` are accepted as well.

    Raises:
        RequestError: the pattern is invalid, or longer than `MAX_PATTERN_LENGTH`.
    """

    def __init__(self, pattern: str) -> None:
        if len(pattern) > MAX_PATTERN_LENGTH:
            raise RequestError(
                Refusal.FAILED, f"the filter has more than {MAX_PATTERN_LENGTH} characters"
            )
        options = re2.Options()
        options.log_errors = False  # RE2 would write to stderr; the caller reports the error.
        try:
            self._expression = re2.compile(pattern, options)
        except (re2.error, UnicodeEncodeError) as error:
            raise RequestError(
                Refusal.FAILED,
                f"the filter {pattern!r} is not a regular expression: {_reason(error)}",
            ) from error

    def is_in(self, name: str) -> bool:
        """Return whether the pattern matches some part of a name."""
        return self._expression.search(name) is not None


def _reason(error: Exception) -> str:
    """Return RE2's message, which is bytes."""
    [reason, *_] = error.args or ("",)
    return reason.decode("utf-8", "replace") if isinstance(reason, bytes) else str(error)


@frozen
class Volume:
    """A box, or a ball if it has a radius.

    Attributes:
        low: lowest corner of a box, or centre of a ball, shape (3,).
        high: highest corner of a box, or centre of a ball, shape (3,).
        radius: radius of a ball, 0 for a box.
    """

    low: NDArray[np.float64]
    high: NDArray[np.float64]
    radius: float = 0.0

    def overlaps(self, box: NDArray[np.float64]) -> bool:
        """Return whether an axis-aligned box, corners of shape (2, 3), overlaps the volume."""
        gap = np.maximum(np.maximum(box[0] - self.high, self.low - box[1]), 0.0)
        return bool(np.linalg.norm(gap) <= self.radius)


@frozen
class EntityFilter:
    """Passes entities that match every condition that is set.

    Attributes:
        pattern: regular expression to find in the name, see `NamePattern`; "" for any name.
        categories: accepted categories, empty for any.
        tags: accepted tags, empty for any.
        all_tags: whether an entity needs all of the tags instead of one.
        volume: volume that they overlap, None for anywhere.
    """

    pattern: str = ""
    categories: frozenset[Category] = frozenset()
    tags: frozenset[str] = frozenset()
    all_tags: bool = False
    volume: Volume | None = None

    def choose(self, entities: Entities, motions: EntityMotions) -> list[WorldEntity]:
        """Return the entities that pass.

        Raises:
            RequestError: the pattern is not a regular expression.
        """
        pattern = NamePattern(self.pattern)
        return [
            entity
            for entity in entities
            if pattern.is_in(entity.name) and self._passes(entity, motions)
        ]

    def _passes(self, entity: WorldEntity, motions: EntityMotions) -> bool:
        note = entity.note
        if self.categories and not self._in_category(note.category):
            return False
        matching = self.tags.intersection(note.tags)
        if self.tags and (matching != self.tags if self.all_tags else not matching):
            return False
        if self.volume is None:
            return True
        box = motions.bounds(entity)
        return box is not None and self.volume.overlaps(box)

    def _in_category(self, category: Category) -> bool:
        things = (Category.DYNAMIC_OBJECT, Category.STATIC_OBJECT)
        # OBJECT covers both dynamic and static objects.
        return category in self.categories or (
            Category.OBJECT in self.categories and category in things
        )
