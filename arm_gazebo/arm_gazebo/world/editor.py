"""Spawn, move and delete entities in a running simulation without disturbing its controllers."""

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Protocol, TypeVar

import mujoco
import numpy as np

from arm_gazebo.build_report import shown
from arm_gazebo.errors import GazeboError, Refusal, RequestError, WorldError
from arm_gazebo.feed.state_feed import PreparedModel
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics.world_properties import UNCHANGED
from arm_gazebo.world.changes import (
    NOTHING,
    Matrix,
    Spawned,
    WorldChanges,
    changed_model,
    quaternion_of,
)
from arm_gazebo.world.entity import (
    NAMESPACE,
    WORLD_FRAME,
    Category,
    Entities,
    EntityNote,
    WorldEntity,
)
from arm_gazebo.world.entity_motion import EntityMotions
from arm_gazebo.world.spawn_model import ModelSource
from arm_node.frozen import frozen

logger = logging.getLogger(__name__)

ResultT = TypeVar("ResultT")


class LoopCall(Protocol):
    """Runs a function on the simulation's thread, between two ticks."""

    def __call__(self, function: Callable[[], ResultT], /) -> ResultT:
        """Return the function's result, or raise its exception."""
        ...


class ModelHolder(Protocol):
    """Stores indices or views of the simulation's model."""

    def rebind(self) -> None:
        """Look them up again. Called on the simulation's thread, right after the model swap."""
        ...


class ModelFeed(Protocol):
    """Shows the simulation's model in another process."""

    def prepare(self, model: mujoco.MjModel, /) -> PreparedModel:
        """Return a model to show once the simulation uses it."""
        ...


@frozen
class SpawnRequest:
    """A request to spawn a model.

    Attributes:
        name: name of the entity; "" for a generated name, if renaming is allowed.
        uri: URI of its file; takes precedence over `text`.
        text: URDF, SDF or MJCF.
        pose: (4, 4) pose in `frame`.
        frame: see `WorldEditor.in_world`.
        namespace: namespace of its topics.
        allow_renaming: whether it may get another name.
    """

    name: str
    uri: str
    text: str
    pose: Matrix
    frame: str = ""
    namespace: str = ""
    allow_renaming: bool = False


class WorldEditor:
    """Builds each new model beside the running one, then lets the simulation swap them.

    Use it from one thread other than the simulation's: every method may wait for a tick, and for a
    model to compile. All methods raise RequestError if they refuse a request; the world is then
    unchanged. The holders look up their indices in the model after each swap, and the feeds receive
    each new model.

    Attributes:
        on_loop: runs functions on the simulation's thread.
        source: reads models to spawn.
        entities: the present entities.
        base: the world without changes.
        changes: the present changes to the world; the same object until they change.
        watchers: called after each change of the world, on the editor's thread.
    """

    def __init__(
        self,
        simulation: Physics,
        on_loop: LoopCall,
        holders: Sequence[ModelHolder],
        feeds: Sequence[ModelFeed],
        source: ModelSource,
    ) -> None:
        self._simulation = simulation
        self.on_loop = on_loop
        self._holders = tuple(holders)
        self._feeds = tuple(feeds)
        self.source = source
        self.watchers: list[Callable[[], None]] = []
        self.base = simulation.built
        self._built = simulation.built
        self.changes = NOTHING
        self._notes: Mapping[str, EntityNote] = {}
        self._take_model()

    @property
    def model(self) -> mujoco.MjModel:
        """The present model; do not modify it."""
        return self._built.model

    def model_with(self, changes: WorldChanges) -> BuiltModel:
        """Return a new model of the present world with other changes."""
        try:
            return changed_model(self.base, changes)
        except (WorldError, KeyError, AttributeError) as error:
            # A body that was deleted or moved may not exist in this world.
            raise RequestError(Refusal.FAILED, f"the world cannot be changed: {error}") from error

    def change_to(self, changes: WorldChanges, then: Callable[[], None] = lambda: None) -> None:
        """Continue with other changes to the same world, which were its `changes` before.

        What is in both keeps its state; the rest starts where it was spawned. `then` is called on
        the simulation's thread, before the next tick.
        """
        if changes is not self.changes:
            self._change(changes, then)
        else:
            self.on_loop(then)
            self.announce()

    def motions(self) -> EntityMotions:
        """Return the present poses and velocities of all entities."""
        # Between two ticks: while it steps, the running model hides some of its shapes.
        self.on_loop(lambda: self._motions.take(self._simulation.state()))
        return self._motions

    def spawn(self, request: SpawnRequest) -> str:
        """Spawn a model into the world; return the name of the entity."""
        if request.namespace and not NAMESPACE.fullmatch(request.namespace):
            raise RequestError(
                Refusal.NAMESPACE_INVALID,
                f"'{request.namespace}' is not a namespace; it takes letters, digits, underscores "
                "and slashes",
            )
        self.entities.name_for(request.name, request.allow_renaming, "entity")
        pose = self.in_world(request.pose, request.frame)
        model = self.source.read(request.uri, request.text)
        name = self.entities.name_for(request.name, request.allow_renaming, model.root)
        for finding in shown(model.findings):
            logger.log(finding.outcome.level, "entity '%s': %s", name, finding)
        self._change(self.changes.with_spawned(Spawned(name, model, pose)))
        return name

    def delete(self, name: str) -> None:
        """Delete an entity. Robots are refused, because their controllers would remain."""
        entity = self.entities.find(name)
        if entity.is_robot:
            raise RequestError(
                Refusal.FAILED,
                f"'{name}' is a robot of the launch with controllers and cannot be deleted",
            )
        self._change(self.changes.without(entity.roots[0]))

    def place(self, name: str, pose: Matrix | None, frame: str, twist: np.ndarray | None) -> None:
        """Set the pose or the velocity of an entity.

        Args:
            name: name of the entity.
            pose: (4, 4) pose in `frame`; None to keep the present pose.
            frame: frame of pose and velocity, see `in_world`.
            twist: linear and angular velocity, shape (6,). None means zero velocity with a new
                pose, and the present velocity without one.
        """
        entity = self.entities.find(name)
        if entity.free_joint:
            self._place_free(entity, pose, frame, twist)
        elif entity.is_robot:
            raise RequestError(Refusal.FAILED, f"'{name}' is a robot that is bolted down")
        elif twist is not None and np.any(twist):
            raise RequestError(Refusal.FAILED, f"'{name}' is not a free body and takes no velocity")
        elif pose is not None:
            world_pose = self.in_world(pose, frame)
            self._change(self.changes.with_moved(entity.roots[0], world_pose @ entity.origin))

    def describe(self, name: str, note: EntityNote) -> None:
        """Store a client's description of an entity."""
        entity = self.entities.find(name)
        if (note.category is Category.ROBOT) != entity.is_robot:
            raise RequestError(
                Refusal.FAILED,
                f"'{name}' must stay in its category: only robots of the launch are robots",
            )
        self._notes = {**self._notes, name: note}
        self._take_model()

    def undo(self, spawned: bool, moved: bool, then: Callable[[], None]) -> None:
        """Undo changes to the world.

        Args:
            spawned: whether to undo everything: spawns, deletions, moves, changed properties.
            moved: whether to undo the moves of static things.
            then: called on the simulation's thread, before the next tick.
        """
        if spawned:
            then = self._with_own_properties(then)
        if spawned and self.changes != NOTHING:
            self._change(NOTHING, then)
        elif moved and self.changes.moved:
            self._change(replace(self.changes, moved={}), then)
        else:
            self.on_loop(then)
            self.announce()

    def _with_own_properties(self, then: Callable[[], None]) -> Callable[[], None]:
        def begin() -> None:
            if self._simulation.properties != UNCHANGED:
                self._simulation.set_properties(UNCHANGED)
            then()

        return begin

    def replace_world(self, base: BuiltModel) -> None:
        """Continue in another world with the same robots in their present state."""
        self._notes = {}
        self._swap(base, base.robot_roots)
        self.base, self.changes = base, NOTHING
        self._take_model()

    def announce(self) -> None:
        """Tell the watchers that the world has changed."""
        for watcher in self.watchers:
            watcher()

    def in_world(self, pose: Matrix, frame: str) -> Matrix:
        """Return a pose (4, 4) in the world.

        Args:
            pose: (4, 4) in `frame`.
            frame: name of an entity or of one of its bodies; "" or "world" for the world.
        """
        return self._frame_pose(frame) @ pose

    def _frame_pose(self, frame: str) -> Matrix:
        if frame in ("", WORLD_FRAME):
            return np.eye(4)
        entity = next((entity for entity in self.entities if entity.name == frame), None)
        if entity is not None:
            return self.motions().of(entity).pose
        if mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, frame) < 0:
            raise RequestError(
                Refusal.INVALID_POSE,
                f"no frame '{frame}'; there are {WORLD_FRAME}, the entities and their links",
            )
        return self.motions().pose(frame)

    def _place_free(
        self, entity: WorldEntity, pose: Matrix | None, frame: str, twist: np.ndarray | None
    ) -> None:
        frame_pose = self._frame_pose(frame)
        motion = self.motions().of(entity)
        at = motion.pose if pose is None else frame_pose @ pose
        linear, angular = np.zeros(3), np.zeros(3)
        if twist is not None:
            linear, angular = frame_pose[:3, :3] @ twist[:3], frame_pose[:3, :3] @ twist[3:]
        elif pose is None:
            linear, angular = motion.linear, motion.angular
        root = at @ entity.origin
        position = np.concatenate((root[:3, 3], quaternion_of(root)))
        linear = linear + np.cross(angular, root[:3, 3] - at[:3, 3])
        velocity = np.concatenate((linear, root[:3, :3].T @ angular))
        self.on_loop(lambda: self._simulation.place(entity.free_joint, position, velocity))

    def _change(self, changes: WorldChanges, then: Callable[[], None] = lambda: None) -> None:
        """Continue with other changes to the same world; `then` is called in the same tick."""
        try:
            built = changed_model(self.base, changes)
        except WorldError as error:
            raise RequestError(Refusal.FAILED, str(error)) from error
        model = self._built.model
        known = [model.body(body).name for body in np.flatnonzero(model.body_parentid == 0)]
        self._swap(built, frozenset(known), then)
        self.changes = changes
        names = {entity.name for entity in Entities(built, changes, {})}
        self._notes = {name: note for name, note in self._notes.items() if name in names}
        self._take_model()

    def _swap(
        self, built: BuiltModel, roots: frozenset[str], then: Callable[[], None] = lambda: None
    ) -> None:
        prepared: list[PreparedModel] = []
        try:
            following = self._simulation.prepare(built, roots)
            for feed in self._feeds:
                prepared.append(feed.prepare(built.model))
        except (GazeboError, MemoryError, ValueError, mujoco.FatalError) as error:
            for model in prepared:
                model.discard()
            raise RequestError(Refusal.FAILED, f"the world cannot be changed: {error}") from error

        def swap() -> mujoco.MjData:
            before = self._simulation.data
            self._simulation.swap(following)
            for holder in self._holders:
                holder.rebind()
            for model in prepared:
                model.show()
            then()
            return before

        # The old state is returned, so that this thread frees it and not the loop thread.
        self.on_loop(swap)
        self._built = built

    def _take_model(self) -> None:
        self.entities = Entities(self._built, self.changes, self._notes)
        self._motions = EntityMotions(self._built.model)
        self.announce()
