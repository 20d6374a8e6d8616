"""Proof that a motion is free of collisions, not only at samples.

Between two states a pair of bodies comes nearer by no more than the sum, over the joints between
them, of the joint's motion times the largest distance from its axis (`reach`). So a state in which
the bodies are a distance apart proves an interval around it (F. Schwarzer, M. Saha and J.-C.
Latombe, "Adaptive dynamic collision checking for single and multiple articulated robots in complex
environments", 2005). The proof goes along the path from one such interval to the next. Where these
intervals are short, the speeds in the state prove longer ones (`approach`).
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import ceil, log

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_planning.collision.approach import Approach, Near
from arm_planning.collision.contact import CollisionContact
from arm_planning.collision.model import CollisionModel
from arm_planning.collision.reach import Reach, reach

Array = NDArray[np.float64]

FLOOR_M = 1e-4
"""A state with less than this counts as an obstruction: it would prove too short an interval."""
LEAST_FLOOR_M = 2e-6
ERROR_M = 2e-6
"""More than the error of MuJoCo's distances."""
MAX_STATES = 20_000
"""Most states that a proof of one path looks at, about a second."""
FIRST_MARGIN_M = 0.05
STEP_OF_MARGINS = 1.4
LOOK_AHEAD = 1.3
"""Factor of an interval by `reach` for which distances are found in the next state: speeds seldom
prove more, and farther bodies cost time."""
WORTH_SPEEDS = 16
"""Intervals by `reach` that the rest of a chord must need for speeds to be worth their time."""
LEAST_PART = 1e-9
NOT_MOVING = 1e-12
CONTACT_FULL = int(mujoco.mjtWarning.mjWARN_CONTACTFULL)


@dataclass(frozen=True, slots=True)
class Obstruction:
    """Where a path is not proved to be free.

    Attributes:
        segment: index of the chord, from way point `segment` to the next.
        fraction: where on the chord, 0 to 1.
        contact: what is there; its depth is negative if it is only too close. None if the proof
            gave up.
        reason: a sentence's end: "link3 with box1, 3 mm deep".
        away: direction, (n,), in which the joints take the two apart soonest; None if the proof
            gave up, or no joint moves them.
    """

    segment: int
    fraction: float
    contact: CollisionContact | None
    reason: str
    away: Array | None = field(default=None, compare=False)

    def __str__(self) -> str:
        return self.reason


class MotionProof:
    """Proves that motions are free.

    What is proved is free. Not all that is free is proved: 0.1 mm of clearance are always enough,
    with less a proof may fail, unless the two bodies do not move against each other. If two bodies
    are closer than 0.1 mm, though not in contact, at the start or at the end of the path, then half
    of that distance is enough for the two on the whole path: so an arm may leave a place where it
    nearly touches. Closer than 4 um is never enough.

    Not thread-safe: one thread at a time.

    Args:
        model: the robot and its surroundings; its joints are the path's columns.
    """

    def __init__(self, model: CollisionModel) -> None:
        self._checker = model
        self._posed = model.posed
        self._model, self._data = self._posed.model, self._posed.data
        self._scale = np.abs(self._posed.coordinates.matrix)
        self._range = self._limits()
        self._slides = self._model.jnt_type == int(mujoco.mjtJoint.mjJNT_SLIDE)
        self._usual = reach(self._model, self._data, *self._range)
        self._states = 0
        self._margin_m = FIRST_MARGIN_M
        self._ends: tuple[Array, Array] = (self._range[0], self._range[0])
        self._relaxed: dict[tuple[int, int], float] | None = None
        self._set_reach(self._usual)

    def prove(self, path: Array, deviation: Array | None = None) -> Obstruction | None:
        """Prove that a path is free, or find what is in its way.

        Args:
            path: way points, (m, n); the path is straight between them, in joint space.
            deviation: of each chord and joint, how far a curve may be from the chord, (m - 1, n):
                at each of its moments all joints are that near to one point of the chord.

        Returns:
            None if all states of the polyline and of each such curve are free. Otherwise an
            obstruction: not always the first on the way.

        Raises:
            PlanningError: a position is not finite.
        """
        path = np.asarray(path, np.float64)
        extra = np.zeros((max(len(path) - 1, 1), path.shape[1]))
        if deviation is not None and len(path) > 1:
            extra = np.asarray(deviation, np.float64)
        if self._checker.constant_contacts:
            contact = self._checker.constant_contacts[0]
            return Obstruction(0, 0.0, contact, str(contact))
        if len(path) == 1:
            path = np.repeat(path, 2, axis=0)
        positions = self._posed.positions(path)
        self._cover(positions, extra)
        # Each proof starts alike, so that its answer does not depend on earlier ones.
        self._states, self._margin_m = 0, FIRST_MARGIN_M
        self._data.warning[CONTACT_FULL].number = 0
        self._relaxed = None
        self._ends = (path[0], path[-1])
        try:
            return self._prove_chords(positions, extra @ self._scale.T)
        finally:
            # The checks of single states look for contacts only.
            self._posed.set_margins(0.0)

    def is_free_edge(self, a: Array, b: Array) -> bool:
        """Return whether the straight motion from one state to another is proved to be free.

        Args:
            a: positions of the joints, (n,).
            b: likewise.
        """
        return self._checker.is_free(b) and self.prove(np.stack([a, b])) is None

    def _prove_chords(self, positions: Array, extra: Array) -> Obstruction | None:
        """Prove chords that are given in MuJoCo's coordinates."""
        for segment, (start, end, spread) in enumerate(
            zip(positions[:-1], positions[1:], extra, strict=True)
        ):
            obstruction = self._prove_chord(segment, start, end - start, spread)
            if obstruction is not None:
                return obstruction
        if self._data.warning[CONTACT_FULL].number:
            # Those that found no room are not known.
            return Obstruction(0, 0.0, None, "not proved: too many shapes are close to each other")
        return None

    def _set_reach(self, bounds: Reach) -> None:
        model = self._model
        self._reach, self._count = bounds, len(bounds.pairs)
        self._bounds = bounds.pairs.reshape(-1, model.nq)
        self._approach = Approach(model, self._data, bounds)
        self._part_of = bounds.part.tolist()
        first, second = bounds.part[model.pair_geom1], bounds.part[model.pair_geom2]
        self._margins = [(model.pair_margin, first * self._count + second)]
        if (model.body_contype | model.body_conaffinity).any():
            # MuJoCo adds the margins of two geoms, so those of what is fixed stay 0.
            self._margins += [
                (model.geom_margin, bounds.part * self._count),
                (model.body_margin, bounds.part_of_body * self._count),
            ]

    def _limits(self) -> Array:
        """Return the ranges of MuJoCo's coordinates within finite limits, (2, nq)."""
        limits = np.array([self._checker.limits(joint) for joint in self._checker.joints])
        limits = np.where(np.isfinite(limits), limits, 0.0).reshape(-1, 2)
        ends = limits.T[:, None] * self._posed.coordinates.matrix
        low, high = np.sort(ends, axis=0).sum(axis=2) + self._posed.coordinates.constant
        return np.stack([low, high])

    def _cover(self, positions: Array, extra: Array) -> None:
        """Take other bounds if a sliding joint leaves its limits: it carries what turns farther."""
        if not self._slides.any():
            return
        spread = (extra @ self._scale.T).max(axis=0)
        low = np.minimum(positions.min(axis=0) - spread, self._range[0])
        high = np.maximum(positions.max(axis=0) + spread, self._range[1])
        beyond = (low < self._range[0]) | (high > self._range[1])
        if (beyond & self._slides).any():
            self._set_reach(reach(self._model, self._data, low, high))
        elif self._reach is not self._usual:
            self._set_reach(self._usual)

    def _relaxed_floors(self) -> dict[tuple[int, int], float]:
        """Return the floors of what is closer than the usual one at an end of the path."""
        floors: dict[tuple[int, int], float] = {}
        # The chord that is being proved goes on with its margins, in the same state.
        before, here = [out.copy() for out, _ in self._margins], self._data.qpos.copy()
        self._posed.set_margins(FLOOR_M + ERROR_M)
        for q in self._ends:
            self._posed.place(q)
            mujoco.mj_collision(self._model, self._data)
            found = self._data.contact
            for geoms, distance in zip(found.geom.tolist(), found.dist.tolist(), strict=True):
                pair = self._bodies_of(geoms)
                floor = max((distance - ERROR_M) / 2, LEAST_FLOOR_M)
                floors[pair] = min(floor, floors.get(pair, FLOOR_M))
        for (out, _), margin in zip(self._margins, before, strict=True):
            out[:] = margin
        self._data.qpos[:] = here
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)
        return floors

    def _bodies_of(self, geoms: list[int]) -> tuple[int, int]:
        first, second = (int(self._model.geom_bodyid[geom]) for geom in geoms)
        return (min(first, second), max(first, second))

    def _prove_chord(
        self, segment: int, start: Array, change: Array, spread: Array
    ) -> Obstruction | None:
        """Prove one chord, as fractions from 0 to 1 of its motion."""
        rates = self._bounds @ np.abs(change)
        lost = self._bounds @ np.abs(spread) + ERROR_M
        floors = np.where((rates > 0.0) | (lost > ERROR_M), FLOOR_M, 0.0)
        rates = np.maximum(rates, NOT_MOVING)
        fastest = float(rates.max())
        set_margins = self._margin_setter(rates, lost)
        nearest = self._searcher(rates, lost, floors)
        self._approach.begin(change)
        model, data, qpos = self._model, self._data, self._data.qpos
        place, look, add_scaled = mujoco.mj_kinematics, mujoco.mj_collision, mujoco.mju_addScl
        proved, guess = 0.0, min(1.0, self._margin_m / fastest)
        # Proved intervals farther on; what lies before them is not.
        ahead: list[tuple[float, float]] = []
        while proved < 1.0:
            at = (proved + ahead[-1][0]) / 2 if ahead else min(proved + guess, 1.0)
            self._states += 1
            if self._states > MAX_STATES:
                return Obstruction(segment, at, None, f"not proved with {MAX_STATES} states")
            horizon = set_margins(1.2 * guess)
            add_scaled(qpos, start, change, at)
            place(model, data)
            look(model, data)
            near, is_close = nearest(horizon)
            if is_close:
                obstruction = self._obstruction(segment, at, lost, floors)
                if obstruction is not None:
                    return obstruction
            clear = least = near[0][0] if near else horizon
            if near and least * WORTH_SPEEDS < 1.0 - proved:
                clear = self._approach.clear(near, horizon)
            guess = LOOK_AHEAD * least if clear == horizon else min(clear, LOOK_AHEAD * least)
            if at - clear > proved:
                ahead.append((at - clear, at + clear))
                continue
            proved = at + clear
            while ahead and ahead[-1][0] <= proved:
                proved = max(proved, ahead.pop()[1])
        self._margin_m = min(guess, 1.0) * fastest
        return None

    def _margin_setter(self, rates: Array, lost: Array) -> Callable[[float], float]:
        """Return what sets margins for a part of a chord, or more, and returns which part.

        Parts are powers of a number, so that the same margins often serve the next state.
        """
        margins = [(out, rates[which], lost[which]) for out, which in self._margins]
        last = 0.0

        def set_margins(least: float) -> float:
            nonlocal last
            if last / STEP_OF_MARGINS < least <= last:
                return last
            step = ceil(log(max(least, LEAST_PART), STEP_OF_MARGINS))
            horizon = min(STEP_OF_MARGINS**step, 1.0)
            if horizon != last:
                for out, rate, constant in margins:
                    np.multiply(rate, horizon, out=out)
                    np.add(out, constant, out=out)
                last = horizon
            return horizon

        return set_margins

    def _searcher(
        self, rates: Array, lost: Array, floors: Array
    ) -> Callable[[float], tuple[list[Near], bool]]:
        """Return what finds the pairs that are near, and whether one is too close.

        It returns those that `reach` proves for less than a part of the chord, the most urgent
        first.
        """
        rate_of, lost_of, floor_of = rates.tolist(), lost.tolist(), floors.tolist()
        data, part_of, count = self._data, self._part_of, self._count

        def nearest(horizon: float) -> tuple[list[Near], bool]:
            near: list[Near] = []
            is_close = False
            found = data.contact
            # Contacts are few: one by one is faster than as arrays.
            for (first, second), distance in zip(
                found.geom.tolist(), found.dist.tolist(), strict=True
            ):
                pair = part_of[first] * count + part_of[second]
                slack = distance - lost_of[pair]
                is_close = is_close or slack < floor_of[pair]
                part = slack / rate_of[pair]
                if part < horizon:
                    near.append((part, slack, pair, first, second))
            near.sort()
            return near, is_close

        return nearest

    def _obstruction(
        self, segment: int, at: float, lost: Array, floors: Array
    ) -> Obstruction | None:
        """Return the deepest of the contacts that are too close, after the exceptions."""
        contacts, found = list(self._posed.found()), self._data.contact
        parts = self._reach.part[found.geom] @ (self._count, 1)
        slack, floors = found.dist - lost[parts], floors[parts]
        pairs = [self._bodies_of(geoms) for geoms in found.geom.tolist()]
        if self._relaxed is None and float(slack.min()) > LEAST_FLOOR_M:
            self._relaxed = self._relaxed_floors()
        relaxed = self._relaxed or {}
        close = [
            number
            for number in np.flatnonzero(slack < floors).tolist()
            if slack[number] < relaxed.get(pairs[number], floors[number])
        ]
        if not close:
            return None
        closest = min(close, key=lambda number: slack[number])
        contact = contacts[closest]
        reason = str(contact)
        if contact.depth_m < 0.0:
            # A curve may come nearer than its chord, by what is lost.
            needed_m = FLOOR_M + lost[parts[closest]] - ERROR_M
            reason += f", closer than the {needed_m * 1e3:.2g} mm that the proof of a motion needs"
        return Obstruction(segment, at, contact, reason, self._away(closest))

    def _away(self, number: int) -> Array | None:
        """Return the direction of the joints in which the bodies of a contact part soonest."""
        model, found = self._model, self._data.contact
        normal, point = found.frame[number, :3], found.pos[number]
        jacobian, away = np.zeros((3, model.nv)), np.zeros(model.nv)
        mujoco.mj_comPos(model, self._data)
        for geom, sign in zip(found.geom[number].tolist(), (-1.0, 1.0), strict=True):
            body = int(model.geom_bodyid[geom])
            mujoco.mj_jac(model, self._data, jacobian, None, point, body)
            away += sign * (normal @ jacobian)
        change = away @ self._posed.coordinates.matrix
        length = float(np.linalg.norm(change))
        return change / length if length > NOT_MOVING else None
