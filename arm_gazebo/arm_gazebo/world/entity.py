"""What there is in a simulated world, as its clients know it."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from enum import Enum

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.names import listing
from arm_gazebo.free_name import free_name
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.world.changes import WorldChanges
from arm_gazebo.world.refusal import Refusal, RefusedError

NAME = re.compile(r"[A-Za-z0-9_.\-]{1,100}", re.ASCII)
NAMESPACE = re.compile(r"/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*", re.ASCII)
WORLD_FRAME = "world"


class Category(Enum):
    """Kinds of entities; the values are those of simulation_interfaces."""

    OBJECT = 0
    ROBOT = 1
    HUMAN = 2
    DYNAMIC_OBJECT = 4
    STATIC_OBJECT = 5


@dataclass(frozen=True, slots=True)
class EntityNote:
    """What is known about an entity beside its motion.

    Attributes:
        category: what kind of thing it is.
        description: for people.
        tags: for filters.
    """

    category: Category
    description: str = ""
    tags: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Entity:
    """A thing in the world, or a robot.

    Attributes:
        name: what clients call it.
        roots: names of its bodies right below the world.
        note: what is known about it.
        free_joint: joint by which the first root moves, "" where it cannot.
        origin: pose (4, 4) of the first root in the entity's frame, mostly the same.
    """

    name: str
    roots: tuple[str, ...]
    note: EntityNote
    free_joint: str = ""
    origin: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))

    @property
    def is_robot(self) -> bool:
        """Whether controllers may drive it, so that it stays."""
        return self.note.category is Category.ROBOT


class Entities:
    """The entities of one model, by name.

    Args:
        built: the model.
        changes: tell which things were spawned, under which names.
        notes: what clients said about entities, instead of what follows from the model.
    """

    def __init__(
        self, built: BuiltModel, changes: WorldChanges, notes: Mapping[str, EntityNote]
    ) -> None:
        model, robots = built.model, built.robot_roots
        things = {spawned.root: spawned for spawned in changes.spawned}
        found: dict[str, Entity] = {}
        for name, roots in built.robots.items():
            if not roots:
                continue
            note = EntityNote(Category.ROBOT, "a robot of the launch", ("robot",))
            found[name] = Entity(name, roots, notes.get(name, note), _free_joint(model, roots))
        for body in np.flatnonzero(model.body_parentid == 0).tolist():
            root = model.body(body).name
            if body == 0 or root in robots:
                continue
            thing = things.get(root)
            name = thing.name if thing else free_name(root, found)
            note = notes.get(name, _note(model, body, thing.model.format if thing else ""))
            origin = thing.model.origin if thing else np.eye(4)
            found[name] = Entity(name, (root,), note, _free_joint(model, (root,)), origin)
        self._found = found

    def __iter__(self) -> Iterator[Entity]:
        return iter(self._found.values())

    def find(self, name: str) -> Entity:
        """Return an entity; RefusedError where there is none."""
        if name not in self._found:
            raise RefusedError(
                Refusal.NOT_FOUND, f"no entity '{name}'; there are {listing(sorted(self._found))}"
            )
        return self._found[name]

    def name_for(self, wanted: str, renaming: bool, default: str) -> str:
        """Return the name that a new entity gets.

        Args:
            wanted: what the client asks for, maybe nothing.
            renaming: whether another one will do.
            default: what to start from where nothing is asked for.

        Raises:
            RefusedError: it is taken, or can be no name.
        """
        if not wanted and not renaming:
            raise RefusedError(
                Refusal.NAME_INVALID, "the name is empty, and allow_renaming is not set"
            )
        name = wanted or re.sub(r"[^A-Za-z0-9_.\-]", "_", default)[:80] or "entity"
        if not NAME.fullmatch(name):
            raise RefusedError(
                Refusal.NAME_INVALID,
                f"the name {name[:120]!r} is none: it takes 1 to 100 letters, digits and _ . -",
            )
        if name not in self._taken:
            return name
        if renaming:
            return free_name(name, self._taken)
        raise RefusedError(
            Refusal.NAME_NOT_UNIQUE, f"there is an entity '{name}' already, or it is 'world'"
        )

    @property
    def _taken(self) -> set[str]:
        return {*self._found, WORLD_FRAME}


def _free_joint(model: mujoco.MjModel, roots: tuple[str, ...]) -> str:
    """Return the name of the joint that lets the first root move freely, or an empty one."""
    if not roots:
        return ""
    first = model.body(roots[0]).jntadr[0]
    if first < 0 or model.jnt_type[first] != mujoco.mjtJoint.mjJNT_FREE:
        return ""
    return str(model.joint(first).name)


def _note(model: mujoco.MjModel, root: int, spawned_from: str) -> EntityNote:
    moves = bool((model.body_dofnum[model.body_rootid == root] > 0).any())
    category = Category.DYNAMIC_OBJECT if moves else Category.STATIC_OBJECT
    if spawned_from:
        return EntityNote(category, f"spawned from {spawned_from.upper()}", ("spawned",))
    return EntityNote(category, "part of the world", ("world",))
