"""The entities of a simulated world, as clients see them."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import field
from enum import Enum

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.mjcf.names import free_name
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.world.changes import WorldChanges
from arm_node.frozen import frozen
from arm_node.names import listing

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


@frozen
class EntityNote:
    """Information about an entity apart from its motion.

    Attributes:
        category: kind of entity.
        description: text for people.
        tags: tags for filters.
    """

    category: Category
    description: str = ""
    tags: tuple[str, ...] = ()


@frozen
class WorldEntity:
    """An object in the world, or a robot.

    Attributes:
        name: name of the entity.
        roots: names of its top-level bodies.
        note: information about it.
        free_joint: free joint of the first root, "" if it cannot move freely.
        origin: pose (4, 4) of the first root in the entity's frame, usually the identity.
    """

    name: str
    roots: tuple[str, ...]
    note: EntityNote
    free_joint: str = ""
    origin: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))

    @property
    def is_robot(self) -> bool:
        """Whether it is a robot, which controllers drive and which cannot be deleted."""
        return self.note.category is Category.ROBOT


class Entities:
    """The entities of one model, by name.

    The notes are descriptions by clients, which override those from the model.
    """

    def __init__(
        self, built: BuiltModel, changes: WorldChanges, notes: Mapping[str, EntityNote]
    ) -> None:
        model, robots = built.model, built.robot_roots
        things = {spawned.root: spawned for spawned in changes.spawned}
        found: dict[str, WorldEntity] = {}
        for name, roots in built.robots.items():
            if not roots:
                continue
            note = EntityNote(Category.ROBOT, "a robot of the launch", ("robot",))
            found[name] = WorldEntity(name, roots, notes.get(name, note), _free_joint(model, roots))
        for body in np.flatnonzero(model.body_parentid == 0).tolist():
            root = model.body(body).name
            if body == 0 or root in robots:
                continue
            thing = things.get(root)
            name = thing.name if thing else free_name(root, found)
            note = notes.get(name, _note(model, body, thing.model.format if thing else ""))
            origin = thing.model.origin if thing else np.eye(4)
            found[name] = WorldEntity(name, (root,), note, _free_joint(model, (root,)), origin)
        self._found = found

    def __iter__(self) -> Iterator[WorldEntity]:
        return iter(self._found.values())

    def find(self, name: str) -> WorldEntity:
        """Return an entity; raise RequestError if it does not exist."""
        if name not in self._found:
            raise RequestError(
                Refusal.NOT_FOUND,
                f"no entity '{name}'; there are {listing(sorted(self._found))}",
            )
        return self._found[name]

    def name_for(self, wanted: str, renaming: bool, default: str) -> str:
        """Return the name for a new entity: the wanted one, or one made from the default.

        With `renaming` another name will do if it is taken.

        Raises:
            RequestError: the name is taken or invalid.
        """
        if not wanted and not renaming:
            raise RequestError(
                Refusal.NAME_INVALID, "the name is empty, and allow_renaming is not set"
            )
        name = wanted or re.sub(r"[^A-Za-z0-9_.\-]", "_", default)[:80] or "entity"
        if not NAME.fullmatch(name):
            raise RequestError(
                Refusal.NAME_INVALID,
                f"the name {name[:120]!r} is invalid: it takes 1 to 100 letters, digits and _ . -",
            )
        if name not in self._taken:
            return name
        if renaming:
            return free_name(name, self._taken)
        raise RequestError(Refusal.NAME_NOT_UNIQUE, f"the name '{name}' is already taken")

    @property
    def _taken(self) -> set[str]:
        return {*self._found, WORLD_FRAME}


def _free_joint(model: mujoco.MjModel, roots: tuple[str, ...]) -> str:
    """Return the name of the first root's free joint, or ""."""
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
