"""Changes the world of a simulation that runs: things come, move and go, controllers go on."""

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol, TypeVar

import mujoco
import numpy as np

from arm_gazebo.errors import GazeboError, WorldError
from arm_gazebo.feed.state_feed import PreparedModel
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.physics.simulation import Simulation
from arm_gazebo.world.changes import Matrix, Spawned, WorldChanges, changed_model, quaternion_of
from arm_gazebo.world.entity import (
    NAMESPACE,
    WORLD_FRAME,
    Category,
    Entities,
    Entity,
    EntityNote,
)
from arm_gazebo.world.entity_motion import EntityMotions
from arm_gazebo.world.refusal import Refusal, RefusedError
from arm_gazebo.world.spawn_model import ModelSource

logger = logging.getLogger(__name__)

ResultT = TypeVar("ResultT")
NOTHING = WorldChanges()


class OnLoop(Protocol):
    """Runs a function on the thread of the simulation, between two ticks."""

    def __call__(self, function: Callable[[], ResultT], /) -> ResultT:
        """Return its result, or raise what it raised."""
        ...


class ModelHolder(Protocol):
    """Keeps indices or views of the simulation's model."""

    def rebind(self) -> None:
        """Look them up again; on the simulation's thread, right after the model was swapped."""
        ...


class ModelFeed(Protocol):
    """Shows the simulation's model elsewhere."""

    def prepare(self, model: mujoco.MjModel, /) -> PreparedModel:
        """Return a model to be shown once the simulation has it."""
        ...


@dataclass(frozen=True, slots=True)
class SpawnRequest:
    """A thing to be spawned.

    Attributes:
        name: "" for one of its own, where renaming is allowed.
        uri: names its file; goes before `text`.
        text: URDF, SDF or MJCF.
        pose: (4, 4) in `frame`.
        frame: see `WorldKeeper.in_world`.
        namespace: for the topics that it might have.
        allow_renaming: whether it may get another name.
    """

    name: str
    uri: str
    text: str
    pose: Matrix
    frame: str = ""
    namespace: str = ""
    allow_renaming: bool = False


class WorldKeeper:
    """Builds each new model beside the running one, then has the simulation swap them.

    One thread, which is not the simulation's: every method may wait for a tick, and for a model
    to be compiled. All raise RefusedError where they cannot do what is asked for; the world then
    is as it was.

    Args:
        simulation: belongs to another thread.
        on_loop: runs functions there.
        holders: look up their places in the model after each swap.
        feeds: get each new model.
        source: where things to be spawned come from.
    """

    def __init__(
        self,
        simulation: Simulation,
        on_loop: OnLoop,
        holders: Sequence[ModelHolder],
        feeds: Sequence[ModelFeed],
        source: ModelSource,
    ) -> None:
        self._simulation = simulation
        self._on_loop = on_loop
        self._holders = tuple(holders)
        self._feeds = tuple(feeds)
        self._source = source
        self._base = simulation.built
        self._built = simulation.built
        self._changes = NOTHING
        self._notes: Mapping[str, EntityNote] = {}
        self._take_model()

    @property
    def model(self) -> mujoco.MjModel:
        """The model as it is now; only to be read."""
        return self._built.model

    @property
    def entities(self) -> Entities:
        """What there is."""
        return self._entities

    def motions(self) -> EntityMotions:
        """Return where everything is now."""
        self._motions.take(self._on_loop(self._simulation.state))
        return self._motions

    def spawn(self, request: SpawnRequest) -> str:
        """Put a thing into the world; return its name."""
        if request.namespace and not NAMESPACE.fullmatch(request.namespace):
            raise RefusedError(
                Refusal.NAMESPACE_INVALID,
                f"'{request.namespace}' is no namespace: letters, digits, underscores, slashes",
            )
        self._entities.name_for(request.name, request.allow_renaming, "entity")
        pose = self.in_world(request.pose, request.frame)
        model = self._source.read(request.uri, request.text)
        name = self._entities.name_for(request.name, request.allow_renaming, model.root)
        for finding in model.findings:
            logger.log(finding.outcome.level, "entity '%s': %s", name, finding)
        self._change(self._changes.with_spawned(Spawned(name, model, pose)))
        return name

    def delete(self, name: str) -> None:
        """Take a thing out of the world; not a robot, whose controllers would be left over."""
        entity = self._entities.find(name)
        if entity.is_robot:
            raise RefusedError(
                Refusal.FAILED,
                f"'{name}' is a robot of the launch, with controllers: it stays until the end",
            )
        self._change(self._changes.without(entity.roots[0]))

    def place(self, name: str, pose: Matrix | None, frame: str, twist: np.ndarray | None) -> None:
        """Put an entity elsewhere, or give it another velocity.

        Args:
            name: of the entity.
            pose: (4, 4) in `frame`; None to leave it where it is.
            frame: of pose and velocity, see `in_world`.
            twist: linear and angular velocity, shape (6,); None for none after a new pose, and
                for the present one without.
        """
        entity = self._entities.find(name)
        if entity.free_joint:
            self._place_free(entity, pose, frame, twist)
        elif entity.is_robot:
            raise RefusedError(Refusal.FAILED, f"'{name}' is a robot that is bolted down")
        elif twist is not None and np.any(twist):
            raise RefusedError(Refusal.FAILED, f"'{name}' is no free body and takes no velocity")
        elif pose is not None:
            world_pose = self.in_world(pose, frame)
            self._change(self._changes.with_moved(entity.roots[0], world_pose @ entity.origin))

    def describe(self, name: str, note: EntityNote) -> None:
        """Keep what a client says about an entity."""
        entity = self._entities.find(name)
        if (note.category is Category.ROBOT) != entity.is_robot:
            raise RefusedError(
                Refusal.FAILED, f"'{name}' stays in its category: a robot is one of the launch"
            )
        self._notes = {**self._notes, name: note}
        self._take_model()

    def reset(self, spawned: bool, state: bool) -> None:
        """Take out what was spawned and bring back what was deleted; put all where it started."""
        if spawned and self._changes != NOTHING:
            self._change(NOTHING)
        elif state and self._changes.moved:
            self._change(replace(self._changes, moved={}))
        if state:
            self._on_loop(lambda: self._simulation.reset(self._simulation.time_s))

    def replace_world(self, base: BuiltModel) -> None:
        """Go on in another world with the same robots, which stay as they are."""
        self._notes = {}
        self._swap(base, base.robot_roots)
        self._base, self._changes = base, NOTHING
        self._take_model()

    def in_world(self, pose: Matrix, frame: str) -> Matrix:
        """Return a pose (4, 4) in the world.

        Args:
            pose: (4, 4) in `frame`.
            frame: the world, where it is empty or "world", an entity, or a body of one.
        """
        return self._frame_pose(frame) @ pose

    def _frame_pose(self, frame: str) -> Matrix:
        if frame in ("", WORLD_FRAME):
            return np.eye(4)
        entity = next((entity for entity in self._entities if entity.name == frame), None)
        if entity is not None:
            return self.motions().of(entity).pose
        if mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, frame) < 0:
            raise RefusedError(
                Refusal.INVALID_POSE,
                f"no frame '{frame}'; there are {WORLD_FRAME}, the entities and their links",
            )
        return self.motions().pose(frame)

    def _place_free(
        self, entity: Entity, pose: Matrix | None, frame: str, twist: np.ndarray | None
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
        self._on_loop(lambda: self._simulation.place(entity.free_joint, position, velocity))

    def _change(self, changes: WorldChanges) -> None:
        """Go on with other changes to the same world."""
        try:
            built = changed_model(self._base, changes)
        except WorldError as error:
            raise RefusedError(Refusal.FAILED, str(error)) from error
        model = self._built.model
        known = [model.body(body).name for body in np.flatnonzero(model.body_parentid == 0)]
        self._swap(built, frozenset(known))
        self._changes = changes
        names = {entity.name for entity in Entities(built, changes, {})}
        self._notes = {name: note for name, note in self._notes.items() if name in names}
        self._take_model()

    def _swap(self, built: BuiltModel, roots: frozenset[str]) -> None:
        prepared: list[PreparedModel] = []
        try:
            following = self._simulation.prepare(built, roots)
            for feed in self._feeds:
                prepared.append(feed.prepare(built.model))
        except (GazeboError, MemoryError, ValueError, mujoco.FatalError) as error:
            for model in prepared:
                model.discard()
            raise RefusedError(Refusal.FAILED, f"the world cannot be like that: {error}") from error

        def swap() -> mujoco.MjData:
            before = self._simulation.data
            self._simulation.swap(following)
            for holder in self._holders:
                holder.rebind()
            for model in prepared:
                model.show()
            return before

        # What was before comes back with the answer, and is freed on this thread.
        self._on_loop(swap)
        self._built = built

    def _take_model(self) -> None:
        self._entities = Entities(self._built, self._changes, self._notes)
        self._motions = EntityMotions(self._built.model)
