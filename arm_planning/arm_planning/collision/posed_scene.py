"""A compiled scene with the robot in a state."""

from collections.abc import Iterable, Iterator, Sequence
from math import inf

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_node.rigid_transform import Vector
from arm_planning.collision.contact import BodyKind, CollisionContact
from arm_planning.collision.reach import never_touching
from arm_planning.collision.specification import SELF, CollisionBody, CompiledScene
from arm_planning.errors import InvalidStateError, PlanningError

Array = NDArray[np.float64]

ORDER = {BodyKind.ROBOT_LINK: 0, BodyKind.ROBOT_ATTACHED: 1, BodyKind.WORLD_OBJECT: 2}
WITH_LIBCCD = int(mujoco.mjtDisableBit.mjDSBL_NATIVECCD)
"""Makes MuJoCo look for contacts with libccd. Its depths are rougher, so that a state of meshes in
contact takes three quarters of the time; one of 200 000 states was free that touches by 0.5 um."""

KEEPING_FIXED_GEOMS = int(mujoco.mjtEnableBit.mjENBL_SLEEP)
"""Makes MuJoCo's kinematics skip geoms of what is fixed in the world: half of its time among 100
objects. Nothing falls asleep, as nothing is simulated."""


class PosedScene:
    """A compiled scene and where its bodies are in the state of the robot that was set last.

    Attributes:
        model: MuJoCo's model.
        data: its state.
        bodies: what each body of the model is, by MuJoCo's id.
        links: MuJoCo's id of the body of each link.
        coordinates: MuJoCo's coordinates as a function of the joints that vary.
    """

    def __init__(self, compiled: CompiledScene) -> None:
        self.model = compiled.model
        self.data = mujoco.MjData(self.model)
        # Where geoms are that do not move is computed here, and kept from then on.
        self.model.opt.enableflags = 0
        mujoco.mj_kinematics(self.model, self.data)
        self.model.opt.enableflags = KEEPING_FIXED_GEOMS
        self.bodies = compiled.bodies
        self.links = compiled.links
        self.coordinates = compiled.coordinates
        self._qpos, self._option = self.data.qpos, self.model.opt
        self._direct = self.coordinates.is_identity

    def leave_out_apart(self) -> None:
        """Leave out what never touches from MuJoCo's search, in which each body takes time.

        It needs no search for pairs of the robot's own geoms where they are named.
        """
        model = self.model
        if model.npair:
            for bits in (
                model.geom_contype,
                model.geom_conaffinity,
                model.body_contype,
                model.body_conaffinity,
            ):
                bits &= ~SELF
        apart = never_touching(model, self.data)
        model.body_contype[apart] = model.body_conaffinity[apart] = 0

    def place(self, q: Array | Sequence[float]) -> None:
        """Set the state.

        Args:
            q: the positions of the joints that vary, (n,).

        Raises:
            PlanningError: a position is not finite.
        """
        if self._direct:
            self._qpos[:] = q
        else:
            self._qpos[:] = self.coordinates(np.asarray(q))
        # MuJoCo finds no contact at all where a number is not finite.
        if not self._qpos.dot(self._qpos) < inf:
            raise _not_finite(q)
        mujoco.mj_kinematics(self.model, self.data)

    def positions(self, states: Array) -> Array:
        """Return MuJoCo's coordinates, (k, nq), in states of the joints that vary, (k, n).

        Raises:
            PlanningError: a position is not finite.
        """
        # MuJoCo finds no contact at all where a number is not finite.
        if not np.vdot(states, states) < inf:
            raise _not_finite(states)
        return states if self._direct else self.coordinates.of_many(states)

    def set_margins(self, distance_m: float) -> None:
        """Set from which distance on two geoms are a contact."""
        self.model.pair_margin[:] = distance_m
        # MuJoCo adds those of two geoms.
        self.model.geom_margin[:] = self.model.body_margin[:] = distance_m / 2.0

    def free_count(self, states: Array, clearance_m: float = 0.0) -> int:
        """Return how many states are free before the first in which something touches.

        It takes two thirds of the time of a call for each state. Depths do not matter here, so they
        are not exact.

        Args:
            states: positions of the joints that vary, (k, n).
            clearance_m: distance from which on two bodies touch.

        Raises:
            PlanningError: a position is not finite.
        """
        positions = self.positions(states)
        model, data, qpos, option = self.model, self.data, self._qpos, self._option
        place, look, usual = mujoco.mj_kinematics, mujoco.mj_collision, option.disableflags
        if clearance_m:
            self.set_margins(clearance_m)
        option.disableflags = usual | WITH_LIBCCD
        free = len(positions)
        for number, row in enumerate(positions):
            qpos[:] = row
            place(model, data)
            look(model, data)
            if data.ncon:
                free = number
                break
        option.disableflags = usual
        if clearance_m:
            self.set_margins(0.0)
        return free

    def found(self) -> Iterator[CollisionContact]:
        """Yield the contacts of the last `mujoco.mj_collision`."""
        found = self.data.contact
        for (first, second), distance, position, frame in zip(
            found.geom.tolist(), found.dist.tolist(), found.pos, found.frame, strict=True
        ):
            yield self._contact(first, second, distance, position, frame[:3])

    def constant_contacts(self, asked: NDArray[np.bool_]) -> Iterator[CollisionContact]:
        """Yield the contacts that are there in every state: of bodies that are welded together.

        MuJoCo does not look for them: the robot's base and the objects of the world never move
        against each other, nor do a gripper and what is attached to it. Its masks and excluded
        pairs count.

        Args:
            asked: which bodies matter, (nbody,); one of a pair must.
        """
        for first, second in _welded(self.model, self.data, asked):
            line = np.zeros(6)
            distance = mujoco.mj_geomDistance(self.model, self.data, first, second, 0.0, line)
            if distance < 0.0:
                # It leads from the surface of the first, inside of the second, to the second's.
                normal = (line[:3] - line[3:]) / -distance
                yield self._contact(first, second, distance, (line[:3] + line[3:]) / 2, normal)

    def _contact(
        self, first_geom: int, second_geom: int, distance: float, position: Array, normal: Array
    ) -> CollisionContact:
        """Name the bodies: links before what is attached, that before objects, then by name."""
        first, second = self._body_of(first_geom), self._body_of(second_geom)
        if (ORDER[first.kind], first.name) > (ORDER[second.kind], second.name):
            first, second, normal = second, first, -normal
        return CollisionContact(
            first.name,
            second.name,
            first.kind,
            second.kind,
            -distance,
            _vector(position),
            _vector(normal),
        )

    def _body_of(self, geom: int) -> CollisionBody:
        body = self.bodies[self.model.geom_bodyid[geom]]
        assert body is not None
        return body


def deepest(contacts: Iterable[CollisionContact]) -> tuple[CollisionContact, ...]:
    """Return the deepest contact of each pair, the deepest first."""
    found: dict[tuple[str, str, BodyKind], CollisionContact] = {}
    for contact in contacts:
        pair = (contact.first, contact.second, contact.second_kind)
        if pair not in found or found[pair].depth_m < contact.depth_m:
            found[pair] = contact
    return tuple(sorted(found.values(), key=lambda contact: -contact.depth_m))


def _not_finite(q: object) -> PlanningError:
    return InvalidStateError(f"a state has positions that are not finite: {q}")


def _vector(values: Array) -> Vector:
    x, y, z = values.tolist()
    return (x, y, z)


def _welded(
    model: mujoco.MjModel, data: mujoco.MjData, asked: NDArray[np.bool_]
) -> list[tuple[int, int]]:
    """Return pairs of geoms on bodies welded together whose bounding spheres overlap."""
    body, weld = model.geom_bodyid, model.body_weldid[model.geom_bodyid]
    firsts, every = np.flatnonzero(asked[body]), np.arange(model.ngeom)
    mine = body[firsts, None]
    may = (weld[firsts, None] == weld) & (mine != body)
    # Both are asked for: the pair comes once.
    may &= ~asked[body] | (every > firsts[:, None])
    may &= (model.geom_contype[firsts, None] & model.geom_conaffinity != 0) | (
        model.geom_conaffinity[firsts, None] & model.geom_contype != 0
    )
    rows, seconds = np.nonzero(may)
    firsts = firsts[rows]
    low, high = np.sort([body[firsts], body[seconds]], axis=0)
    near = ~np.isin((low << 16) + high, model.exclude_signature)
    # A plane has no radius: it is endless.
    radius = np.where(model.geom_rbound > 0.0, model.geom_rbound, np.inf)
    apart = np.linalg.norm(data.geom_xpos[firsts] - data.geom_xpos[seconds], axis=1)
    near &= apart < radius[firsts] + radius[seconds]
    return list(zip(firsts[near].tolist(), seconds[near].tolist(), strict=True))
