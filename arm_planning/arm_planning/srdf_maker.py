"""Makes a whole SRDF for any URDF: default groups, and the pairs of links that need no check.

Links that are joined touch at their joint, those of a gripper where it is open or closed, the
sections of a telescope where it is drawn in, and a wheel what stands beside it. Other pairs are
decided by samples of the joints: those that touch in nearly all states, and those that never come
near each other.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from arm_description.urdf.robot import Box, Capsule, Collision, Cylinder, Robot, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.contact import CollisionContact
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.collision.model import CollisionModel
from arm_planning.joined_links import beside_wheels, joined, telescopes
from arm_planning.repair_search import find_by_repair
from arm_planning.robot.build import planning_model
from arm_planning.robot.default_srdf import default_srdf
from arm_planning.robot.model import PlanningModel
from arm_planning.robot.srdf import Pair, Srdf
from arm_planning.scene.allowed_collisions import allowed_collisions
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Plane

Array = NDArray[np.float64]

MIN_SAMPLES = 10_000
"""Pairs that never touch in 3,000 samples may still touch."""
FIRST_SAMPLES = 500
ALWAYS = 0.95
"""Share of states in which a pair touches that need not be checked, as in MoveIt's assistant."""
AT_LIMITS = 0.1
"""Share of a joint's samples that are at its limits, where links come nearest to each other."""
NEAR_M = 0.002
"""How much the shapes of links are grown, but for meshes: what comes near may touch, too."""
BATCH = 500
HOME = "home"
HOME_SAMPLES = 2_000
"""States to look at, farther and farther away, if the robot collides at home."""
HOME_CLEARANCE_M = 0.005
"""How far apart links are at such a home, if possible: a servo does not hold an arm exactly."""
HOME_MARGIN = 0.2
"""How far around a state without contact one with clearance is looked for, of the way to others."""
HOME_DIGITS = 2
FLOOR = "<floor>"
"""The plane below the root, on which a robot stands in the simulation."""

Warn = Callable[[str], None]


def make_srdf(
    robot: Robot,
    warn: Warn,
    samples: int = MIN_SAMPLES,
    meshes: MeshPieces | None = None,
) -> Srdf:
    """Return an SRDF with default groups and the pairs that are not checked.

    The same robot gives the same SRDF.

    Args:
        robot: the robot.
        warn: is told what collides in the states called home, which are then moved.
        samples: number of states to look at, at least MIN_SAMPLES.
        meshes: cuts meshes, as for `CollisionModel`.

    Raises:
        ValueError: there are too few samples.
        PlanningError: a mesh cannot be used.
    """
    if samples < MIN_SAMPLES:
        raise ValueError(f"{samples} samples are too few; there must be at least {MIN_SAMPLES}")
    pieces = meshes or MeshPieces()
    srdf = default_srdf(robot)
    pairs = dict.fromkeys(joined(robot), "Adjacent")
    sampler = _Sampler(robot, srdf, pieces)
    pairs |= dict.fromkeys(sampler.always(pairs), "Always")
    pairs |= dict.fromkeys(sampler.gripping(pairs), "Default")
    pairs |= dict.fromkeys(sampler.in_line(pairs), "Default")
    touching = sampler.ever(pairs, samples)
    solid = [link.name for link in robot.links if link.collisions]
    every = [(min(a, b), max(a, b)) for i, a in enumerate(solid) for b in solid[i + 1 :]]
    pairs |= {pair: "Never" for pair in every if pair not in pairs and pair not in touching}
    made = replace(srdf, disabled={pair: pairs[pair] for pair in sorted(pairs)})
    return sampler.with_free_home(made, warn)


def free_start(robot: Robot, meshes: MeshPieces | None = None) -> dict[str, float]:
    """Return where the joints start so that the robot touches neither itself nor the floor: home.

    Empty if it is so with all joints at zero, or their limits nearest to it; and if there is no
    other home. It is much faster than `make_srdf`.

    Args:
        robot: the robot, on the floor.
        meshes: cuts meshes, as for `CollisionModel`.

    Raises:
        PlanningError: a mesh cannot be used.
    """
    sampler = _Sampler(robot, default_srdf(robot), meshes or MeshPieces())
    pairs = dict.fromkeys(joined(robot), "Adjacent")
    if not sampler.contacts_at_home(pairs):
        return {}
    pairs |= dict.fromkeys(sampler.always(pairs), "Always")
    pairs |= dict.fromkeys(sampler.gripping(pairs), "Default")
    pairs |= dict.fromkeys(sampler.in_line(pairs), "Default")
    return sampler.free_home(pairs, _ignore)


@dataclass(frozen=True, slots=True)
class _Sampler:
    """Looks at random states of a robot.

    Attributes:
        robot: the robot.
        srdf: its groups.
        meshes: cuts meshes.
    """

    robot: Robot
    srdf: Srdf
    meshes: MeshPieces

    def always(self, known: Mapping[Pair, str], *, with_floor: bool = False) -> set[Pair]:
        """Return the pairs that touch in nearly all states."""
        model = self._model(self.robot)
        collisions = self._collisions(model, known, with_floor=with_floor)
        counts: dict[Pair, int] = {}
        for q in self._states(model, FIRST_SAMPLES):
            for pair in _touching(collisions, q):
                counts[pair] = counts.get(pair, 0) + 1
        return {pair for pair, count in counts.items() if count >= ALWAYS * FIRST_SAMPLES}

    def gripping(self, known: Mapping[Pair, str]) -> set[Pair]:
        """Return the pairs of a gripper's own links that touch at home or in one of its states."""
        model = self._model(self.robot)
        collisions = self._collisions(model, known)
        found: set[Pair] = set()
        for effector in self.srdf.end_effectors.values():
            own = _carried_by(self.robot, self.srdf.groups[effector.group].joints)
            own.add(effector.parent_link)
            states = [state for key, state in self.srdf.states.items() if key[0] == effector.group]
            for state in ({}, *states):
                q = np.array([state.get(joint, (0.0,))[0] for joint in model.joints])
                found |= {pair for pair in _touching(collisions, q) if own.issuperset(pair)}
        return found

    def in_line(self, known: Mapping[Pair, str]) -> set[Pair]:
        """Return the pairs at home that touch, of a telescope's sections or beside a wheel.

        What is between them is one line to slide along or to turn about endlessly: they touch by
        their rough shapes only, or the limits of the joints keep apart what must not meet.
        """
        pairs = {*telescopes(self.robot), *beside_wheels(self.robot)}
        if not pairs:
            return set()
        model = self._model(self.robot)
        home = np.zeros(len(model.joints))
        return _touching(self._collisions(model, known), home) & pairs

    def ever(self, known: Mapping[Pair, str], samples: int) -> set[Pair]:
        """Return the pairs that come near each other in a state.

        What is found is left out from then on, which makes the check of the next states faster.
        """
        model = self._model(_grown(self.robot))
        found: set[Pair] = set()
        collisions = self._collisions(model, known)
        before = 0
        for number, q in enumerate(self._states(model, samples)):
            if number % BATCH == 0 and len(found) > before:
                before = len(found)
                collisions = self._collisions(model, {**known, **dict.fromkeys(found, "")})
            if not collisions.is_free(q):
                found |= _touching(collisions, q)
        return found

    def with_free_home(self, srdf: Srdf, warn: Warn) -> Srdf:
        """Return the SRDF with the states home where nothing collides, near to where they are."""
        moved = self.free_home(srdf.disabled, warn)
        if not moved:
            return srdf
        renewed = {
            key: {joint: (moved[joint],) for joint in state} if key[1] == HOME else state
            for key, state in srdf.states.items()
        }
        return replace(srdf, states=renewed)

    def contacts_at_home(self, known: Mapping[Pair, str]) -> tuple[CollisionContact, ...]:
        """Return what other pairs touch at home, the floor among them."""
        model = self._model(self.robot)
        return self._collisions(model, known, with_floor=True).contacts(self._home(model))

    def free_home(self, known: Mapping[Pair, str], warn: Warn) -> dict[str, float]:
        """Return positions of all joints where no other pair touches; empty if home is so.

        As few joints as possible are moved. What collides is told; if it does in every state that
        is looked at, the result is empty, too.
        """
        contacts = self.contacts_at_home(known)
        if any(FLOOR in (contact.first, contact.second) for contact in contacts):
            # A robot that cannot leave the floor stands on it.
            known = {**known, **dict.fromkeys(self.always(known, with_floor=True), "Always")}
            contacts = self.contacts_at_home(known)
        if not contacts:
            return {}
        model = self._model(self.robot)
        home = self._home(model)
        free = self._free_near(home, model, known)
        still = _touching(
            self._collisions(model, known, with_floor=True), home if free is None else free
        )
        for contact in contacts:
            is_moved = _pair(contact) not in still
            what = "home is moved to a state without contact" if is_moved else "set another state"
            is_own = FLOOR not in (contact.first, contact.second)
            advice = "; if the two may touch, disable their collisions" if is_own else ""
            warn(f"at home {contact}: {what}{advice}")
        return {} if free is None else dict(zip(model.joints, free.tolist(), strict=True))

    def _home(self, model: PlanningModel) -> Array:
        positions: dict[str, float] = {}
        for (_, name), state in model.states.items():
            positions |= state if name == HOME else {}
        return np.array([positions.get(joint, 0.0) for joint in model.joints])

    def _free_near(
        self, home: Array, model: PlanningModel, known: Mapping[Pair, str]
    ) -> Array | None:
        """Return a free state near home, with round numbers; the same ones for the same robot."""
        reaches = np.linspace(0.0, 1.0, HOME_SAMPLES)[:, None]
        states = home + reaches * (np.array([*self._states(model, HOME_SAMPLES)]) - home)
        for with_floor, clearance_m in (
            (True, HOME_CLEARANCE_M),
            (False, HOME_CLEARANCE_M),
            (False, 0.0),
        ):
            is_free = self._free_from(model, known, with_floor, clearance_m)
            if (free := next(filter(is_free, states), None)) is not None:
                return self._tidied(free, home, model, is_free)
        return self._repaired(home, model, known)

    def _repaired(
        self, home: Array, model: PlanningModel, known: Mapping[Pair, str]
    ) -> Array | None:
        """Return a free state near home of a robot whose joints are too many for random states."""
        carried = [_carried_by(self.robot, [joint]) for joint in model.joints]

        def movers(contact: CollisionContact) -> list[int]:
            each = [(contact.first in links) != (contact.second in links) for links in carried]
            return np.flatnonzero(each).tolist()

        for with_floor in (True, False):
            collisions = self._collisions(model, known, with_floor=with_floor)
            free = find_by_repair(home, self._limits(model), collisions.contacts, movers)
            if free is None:
                continue
            around = np.array([*self._states(model, HOME_SAMPLES)]) - free
            nearby = free + np.linspace(0.0, HOME_MARGIN, HOME_SAMPLES)[:, None] * around
            has_clearance = self._free_from(model, known, with_floor, HOME_CLEARANCE_M)
            if (roomy := next(filter(has_clearance, nearby), None)) is not None:
                return self._tidied(roomy, home, model, has_clearance)
            return self._tidied(
                free, home, model, self._free_from(model, known, with_floor, clearance_m=0.0)
            )
        return None

    def _tidied(
        self, free: Array, home: Array, model: PlanningModel, is_free: Callable[[Array], bool]
    ) -> Array:
        """Return a free state with as many joints as possible at home, the others round."""
        for index in range(len(home)):
            less = free.copy()
            less[index] = home[index]
            free = less if is_free(less) else free
        rounded = np.where(free == home, home, np.round(free, HOME_DIGITS))
        inside = np.clip(rounded, *self._limits(model))
        return inside if is_free(inside) else free

    def _free_from(
        self, model: PlanningModel, known: Mapping[Pair, str], with_floor: bool, clearance_m: float
    ) -> Callable[[Array], bool]:
        collisions = self._collisions(model, known, with_floor=with_floor)
        return lambda q: collisions.free_count(q[None], clearance_m) == 1

    def _model(self, robot: Robot) -> PlanningModel:
        return planning_model(robot, self.srdf, warn=_ignore)

    def _collisions(
        self, model: PlanningModel, pairs: Mapping[Pair, str], *, with_floor: bool = False
    ) -> CollisionModel:
        """Return the checks of all pairs but these, and of what moves against the floor."""
        standing = {(FLOOR, link): "" for link in _fixed(self.robot)} if with_floor else {}
        allowed = allowed_collisions(replace(self.srdf, disabled={**pairs, **standing}))
        scene = PlanningScene(dict.fromkeys(model.joints, 0.0), allowed=allowed)
        if with_floor:
            floor = CollisionObject(FLOOR, RigidTransform(), (PlacedShape(Plane(0, 0, 1, 0)),))
            scene = replace(scene, objects={FLOOR: floor})
        return CollisionModel(model, scene, meshes=self.meshes)

    def _limits(self, model: PlanningModel) -> tuple[Array, Array]:
        """Return the least and greatest position of each joint; endless joints make one turn."""
        limits = [self.robot.joint(name).limit for name in model.joints]
        lower = np.array([limit.lower if limit else -np.inf for limit in limits])
        upper = np.array([limit.upper if limit else np.inf for limit in limits])
        lower = np.where(np.isfinite(lower), lower, -np.pi)
        return lower, np.where(np.isfinite(upper), upper, np.pi)

    def _states(self, model: PlanningModel, count: int) -> Iterator[Array]:
        """Yield states of all joints, (n,): the same ones each time."""
        rng = np.random.default_rng(0)
        lower, upper = self._limits(model)
        shares = rng.uniform(-AT_LIMITS / 2, 1.0 + AT_LIMITS / 2, (count, len(lower)))
        yield from lower + (upper - lower) * np.clip(shares, 0.0, 1.0)


def _touching(collisions: CollisionModel, q: Array) -> set[Pair]:
    return set(map(_pair, collisions.contacts(q)))


def _pair(contact: CollisionContact) -> Pair:
    return min(contact.first, contact.second), max(contact.first, contact.second)


def _fixed(robot: Robot) -> set[str]:
    """Return the links that no joint moves."""
    moved = [joint.name for joint in robot.joints if joint.type.is_scalar]
    return {link.name for link in robot.links} - _carried_by(robot, moved)


def _carried_by(robot: Robot, joints: Sequence[str]) -> set[str]:
    """Return the links that joints move."""
    links = [robot.joint(name).child for name in joints]
    for link in links:
        links.extend(joint.child for joint in robot.children(link))
    return set(links)


def _grown(robot: Robot) -> Robot:
    links = tuple(
        replace(link, collisions=tuple(map(_grown_shape, link.collisions))) for link in robot.links
    )
    return replace(robot, links=links)


def _grown_shape(collision: Collision) -> Collision:
    match collision.geometry:
        case Box((x, y, z)):
            grown = Box((x + 2 * NEAR_M, y + 2 * NEAR_M, z + 2 * NEAR_M))
        case Sphere(radius):
            grown = Sphere(radius + NEAR_M)
        case Cylinder(radius, length):
            grown = Cylinder(radius + NEAR_M, length + 2 * NEAR_M)
        case Capsule(radius, length):
            grown = Capsule(radius + NEAR_M, length)
        case mesh:
            return replace(collision, geometry=mesh)
    return replace(collision, geometry=grown)


def _ignore(_sentence: str) -> None:
    """Pass over what does not matter here."""
