"""Inverse kinematics: positions of a group's joints that bring a link to a pose.

A search descends from the seed first, then from starts near the target, then from random ones (see
`descent` and `search`). Its length is counted in steps, not in time, and a timeout is turned into a
number of steps: the same call gives the same answer on a busy machine, or none when its time is up.
"""

import math
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from arm_description.urdf.robot import Robot
from arm_node.names import listing
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import (
    InvalidLinkError,
    InvalidRequestError,
    InvalidStateError,
    MoveItErrorCode,
    PlanningError,
)
from arm_planning.kinematics.chain import Chain
from arm_planning.kinematics.descent import (
    HASTY,
    MAX_STEPS,
    PATIENT,
    Descent,
    DescentEnd,
    target_of,
)
from arm_planning.kinematics.pose_target import checked_pose
from arm_planning.kinematics.search import Orientation, Search, Starts, shortfall
from arm_planning.robot.model import JointGroup, JointPositions, PlanningLimits, PlanningModel

Array = NDArray[np.float64]
Free = Callable[[Array], bool]
"""Says of positions of the group, (n,), whether the robot is free of collisions there."""

TIMEOUT_S = 0.05
"""MoveIt's default of kinematics_solver_timeout."""
MAX_TIMEOUT_S = 60.0
STEPS_PER_S = 20_000
"""What a timeout is worth; a step takes 12 to 25 us."""
FREE_STEPS = 5
"""What a call of `free` costs, in steps."""
LEAST_WAIT_S = 1.0
"""A shorter timeout does not end a search before this, so that a busy machine rarely matters."""
HOPELESS_STEPS = 200
"""For a target farther away than the arm is long: enough to say how near it comes."""
ROTATION_SHARE = 0.25
"""One radian counts as this share of the arm's length; 0.15 to 0.4 do as well."""
NEAREST_WEIGHT = 1000.0
"""Weight of the position where the orientation only has to be near: it is off by 1e-7 m then."""
NEAREST_TRIES = 12
"""Solutions to choose the nearest orientation from."""
SAME_RAD = 1e-3
"""Orientations that differ by less from the target's are equally near."""
STALE = 10
"""Solutions in a row that are not new, after which there are hardly any others."""
ALIKE = 1e-2
"""Solutions whose joints all differ by less than this are one, in rad or m."""
FARTHEST = 1e6
"""Largest position of a joint, rad or m; beyond it, numbers get too coarse."""
PLACE = np.array([[1.0], [1.0], [1.0], [0.0], [0.0], [0.0]])
"""Weights of the position alone."""
CLOSE_M = 1e-4
"""Distance from which a position is brought to the exact place; farther, it is out of reach."""


class InverseKinematics:
    """Finds positions of a group's joints within their limits. For one thread at a time.

    Joints of the group that do not move the tip keep the seed's positions; mimic joints follow.

    Args:
        model: the robot.
        group: name of the group; arrays have the order of its joints.
        tip: the link to place; "" for the group's own tip.
        positions: positions of joints outside of the group; 0 for those not named.
        clock: seconds that pass, for timeouts.

    Attributes:
        group: the group.
        tip: the link that is placed.
        turning: whether each joint of the group turns, (n,); the others slide.

    Raises:
        PlanningError: INVALID_GROUP_NAME or INVALID_LINK_NAME: there is no such group or link, the
            group has no tip, or none of its joints moves the link.
    """

    def __init__(
        self,
        model: PlanningModel,
        group: str,
        tip: str = "",
        positions: JointPositions | None = None,
        *,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.group = model.group(group)
        self.tip = _checked_tip(model, self.group, tip)
        names, fixed = self.group.joints, dict(positions or {})
        self._whole = Chain(model.robot, self.tip, names, fixed)
        self._moving = np.flatnonzero(self._whole.moving)
        if not len(self._moving):
            message = f"no joint of group '{group}' moves link '{self.tip}'"
            raise InvalidLinkError(message)
        self._names = tuple(names[index] for index in self._moving)
        self._chain = Chain(model.robot, self.tip, self._names, fixed)
        self._others = {name: fixed.get(name, 0.0) for name in self._whole.others}
        self._lowest, self._highest = self.group.lower, self.group.upper
        lower, upper = self._lowest[self._moving], self._highest[self._moving]
        self.turning = np.array([model.robot.joint(name).type.turns for name in names])
        turning = self.turning[self._moving]
        self._lower, self._upper, self._turning = lower, upper, turning
        self._descent = Descent(self._chain, lower, upper)
        free = [self._chain.turns_freely(index) for index in range(len(turning))]
        self._turns = np.flatnonzero(turning & free).tolist()
        self._rotation_length = ROTATION_SHARE * self._chain.reach_m or 1.0
        self._starts: Starts | None = None
        self._clock = clock

    @classmethod
    def for_link(cls, robot: Robot, link: str, joints: Sequence[str]) -> "InverseKinematics":
        """Return the inverse kinematics of some joints of a robot without groups.

        Args:
            robot: the robot.
            link: name of the link to place.
            joints: names of the joints, in the order of all arrays; other joints stay at 0.

        Raises:
            UrdfError: the link or a joint does not exist.
            PlanningError: a joint's position is not one number, or no joint moves the link.
        """
        tip = robot.link(link).name
        limits = tuple(_urdf_limits(robot, joint) for joint in joints)
        wraps = tuple(robot.joint(joint).type.wraps for joint in joints)
        group = JointGroup("joints", tuple(joints), wraps, limits, (tip,), robot.root, tip)
        return cls(PlanningModel(robot, robot.root, tuple(joints), {group.name: group}), group.name)

    def holds_for(self, positions: JointPositions) -> bool:
        """Whether the tip is where it would be with these positions of the other joints."""
        return all(positions.get(name, 0.0) == value for name, value in self._others.items())

    def checked(self, state: Sequence[float] | Array) -> Array:
        """Return positions of the group as an array, (n,).

        Raises:
            PlanningError: INVALID_ROBOT_STATE: they are too few or too many, not finite, or too
                large to compute with.
        """
        q = np.asarray(state, dtype=float)
        names = self.group.joints
        if q.shape != (len(names),):
            raise InvalidStateError(
                f"a state of group '{self.group.name}' has {len(names)} positions, for "
                f"{listing(names)}; the given one has the shape {q.shape}"
            )
        usual = np.abs(q) <= FARTHEST
        if not usual.all():
            index = int(usual.argmin())
            why = f"is beyond {FARTHEST:g}" if np.isfinite(q[index]) else "is not finite"
            raise InvalidStateError(f"the position of joint '{names[index]}' {why}: {q[index]:g}")
        return q

    def pose(self, q: Sequence[float] | Array) -> Array:
        """Return the tip's pose in the root's frame, (4, 4), for positions of the group, (n,)."""
        return self._whole.pose(np.asarray(q, dtype=float))

    def tip_pose(self, q: Sequence[float] | Array) -> RigidTransform:
        """Return the same pose as position and quaternion."""
        self._whole.place(np.asarray(q, dtype=float))
        w, x, y, z = self._whole.quaternion.tolist()
        px, py, pz = self._whole.position.tolist()
        return RigidTransform((px, py, pz), (x, y, z, w))

    def solve(
        self,
        target: RigidTransform | Array,
        seed: Sequence[float] | Array,
        *,
        timeout_s: float = 0.0,
        random_seed: int = 0,
        free: Free | None = None,
        orientation: Orientation = Orientation.EXACT,
    ) -> Array:
        """Return positions within the limits that bring the tip to a pose, (n,).

        The pose is reached within 1e-6 m and 1e-5 rad, where the arm is stretched out within ten
        times as much. The search starts at the seed, and of equal turns of a joint the one next to
        the seed is returned.

        Args:
            target: pose in the root link's frame; as an array a homogeneous transform, (4, 4).
            seed: where to start, (n,); moved inside the limits.
            timeout_s: length of the search, as `STEPS_PER_S` steps a second; 0 for the default.
                With a timeout or `free`, the search also ends after so long on the clock, though
                not before `LEAST_WAIT_S`.
            random_seed: seed of the random starts.
            free: says whether the robot is free of collisions; only such positions are returned.
            orientation: whether the orientation is to be met exactly, or as nearly as it can be
                at the position, or does not matter.

        Raises:
            PlanningError: NO_IK_SOLUTION: the message says how near the best one comes, and why.
                INVALID_GOAL_CONSTRAINTS, INVALID_ROBOT_STATE: the target or the seed is not valid.
                TIMED_OUT: the time on the clock is up.
        """
        search = self._search(target, seed, timeout_s, random_seed, free, orientation)
        if orientation is Orientation.NEAREST:
            return self._with_nearest_orientation(search)
        for q, _ in self._solutions(search):
            return q
        raise self._none(search)

    def follow(
        self,
        target: RigidTransform | Array,
        seed: Sequence[float] | Array,
        *,
        orientation: Orientation = Orientation.EXACT,
    ) -> Array:
        """Return the solution that one descent from the seed leads to, (n,).

        For a target near the seed's pose, it is the solution on the same branch.

        Args:
            target: as in `solve`.
            seed: as in `solve`.
            orientation: as in `solve`.

        Raises:
            PlanningError: as in `solve`; the descent ends elsewhere.
        """
        search = self._search(target, seed, 0.0, 0, None, orientation)
        outcome = self._descend(search, search.seed[self._moving], PATIENT)
        if outcome.is_at(search.target, nearest=orientation is Orientation.NEAREST):
            return self._beside_seed(outcome.q, search.seed)
        search.note(outcome)
        raise self._none(search)

    def solutions(
        self,
        target: RigidTransform | Array,
        seed: Sequence[float] | Array,
        *,
        most: int = 8,
        timeout_s: float = 0.0,
        random_seed: int = 0,
        free: Free | None = None,
        orientation: Orientation = Orientation.EXACT,
    ) -> list[Array]:
        """Return different solutions, those nearest to the seed first.

        The search goes on until it has twice as many, or until several descents in a row lead to
        none that is new. Of an arm with more joints than the target takes, they are a sample.

        Args:
            target: as in `solve`.
            seed: as in `solve`.
            most: number of solutions to return at most.
            timeout_s: as in `solve`.
            random_seed: as in `solve`.
            free: as in `solve`.
            orientation: as in `solve`; NEAREST also returns local minima of the angle.

        Raises:
            PlanningError: as in `solve`, if there is none.
        """
        search = self._search(target, seed, timeout_s, random_seed, free, orientation)
        found: list[Array] = []
        stale = 0
        for q, _ in self._solutions(search):
            stale += 1
            if is_new(q, found):
                found.append(q)
                stale = 0
            if stale == STALE or len(found) == 2 * most:
                break
        if not found:
            raise self._none(search)
        return sorted(found, key=search.distance)[:most]

    def _with_nearest_orientation(self, search: Search) -> Array:
        found: list[tuple[Array, DescentEnd]] = []
        for q, outcome in self._solutions(search):
            found.append((q, outcome))
            if outcome.off_rad < SAME_RAD or len(found) == NEAREST_TRIES:
                break
        if not found:
            raise self._none(search)
        least = min(outcome.off_rad for _, outcome in found) + SAME_RAD
        return min((q for q, o in found if o.off_rad <= least), key=search.distance)

    def _search(
        self,
        pose: RigidTransform | Array,
        seed: Sequence[float] | Array,
        timeout_s: float,
        random_seed: int,
        free: Free | None,
        orientation: Orientation,
    ) -> Search:
        position, quaternion = checked_pose(pose)
        length = 0.0 if orientation is Orientation.ANY else self._rotation_length
        weight = NEAREST_WEIGHT if orientation is Orientation.NEAREST else 1.0
        length_s = _checked_timeout(timeout_s)
        is_timed = timeout_s > 0.0 or free is not None
        return Search(
            target=target_of(position, quaternion, length, weight),
            orientation=orientation,
            seed=np.minimum(np.maximum(self.checked(seed), self._lowest), self._highest),
            random_seed=random_seed,
            free=free,
            steps=self._steps(position, length_s),
            until_s=self._clock() + max(length_s, LEAST_WAIT_S) if is_timed else math.inf,
        )

    def _steps(self, position: Array, timeout_s: float) -> int:
        steps = max(MAX_STEPS, round(timeout_s * STEPS_PER_S))
        return min(steps, HOPELESS_STEPS) if self._chain.is_too_short_for(position) else steps

    def _solutions(self, search: Search) -> Iterator[tuple[Array, DescentEnd]]:
        """Yield solutions of all joints of the group, (n,), until the steps are used up."""
        for start in self._all_starts(search):
            outcome = self._descend(search, start, HASTY)
            if not outcome.is_at(search.target, nearest=search.orientation is Orientation.NEAREST):
                search.note(outcome)
            else:
                q = self._beside_seed(outcome.q, search.seed)
                if self._is_free(search, q):
                    yield q, outcome
            if search.steps <= 0:
                return
            if self._clock() > search.until_s:
                raise self._overdue(search)

    def _all_starts(self, search: Search) -> Iterator[Array]:
        yield search.seed[self._moving]
        if self._starts is None:
            self._starts = Starts(self._chain, self._lower, self._upper, self._turning)
        yield from self._starts.towards(search.target, search.random_seed)

    def _descend(self, search: Search, start: Array, patience: float) -> DescentEnd:
        nearest = search.orientation is Orientation.NEAREST
        patience = PATIENT if nearest else patience
        outcome = self._descent.run(search.target, start, min(MAX_STEPS, search.steps), patience)
        search.steps -= outcome.steps
        if not nearest or outcome.off_m > CLOSE_M:
            return outcome
        # Brings the position, against which the orientation was weighed, to the exact place.
        return self._descent.run(
            replace(search.target, rotation_length=0.0, weights=PLACE), outcome.q
        )

    def _beside_seed(self, moved: Array, seed: Array) -> Array:
        """Return the positions of all joints of the group, each on the turn next to the seed's."""
        q = seed.copy()
        q[self._moving] = np.minimum(np.maximum(moved, self._lower), self._upper)
        for index in self._turns:
            joint, lower, upper = self._moving[index], self._lower[index], self._upper[index]
            q[joint] = _nearest_turn(float(q[joint]), float(seed[joint]), lower, upper)
        return q

    def _is_free(self, search: Search, q: Array) -> bool:
        if search.free is None:
            return True
        search.steps -= FREE_STEPS
        is_free = search.free(q)
        if not is_free:
            search.blocked += 1
        return is_free

    def _overdue(self, search: Search) -> PlanningError:
        # What was found so far depends on how busy the machine is, so it only serves as a reason.
        is_known = search.blocked or search.best is not None
        why = str(self._none(search)) if is_known else f"link '{self.tip}' may have other solutions"
        return PlanningError(
            MoveItErrorCode.TIMED_OUT, f"{why}; the time of the search ended with that"
        )

    def _none(self, search: Search) -> PlanningError:
        if search.best is not None:
            search.best = self._descent.run(search.target, search.best.q)
        return PlanningError(
            MoveItErrorCode.NO_IK_SOLUTION,
            shortfall(search, self.tip, self._names, self._lower, self._upper, self._chain),
        )


def is_new(q: Array, others: Iterable[Array]) -> bool:
    """Return whether a solution, (n,), differs from all others."""
    return all(np.abs(q - other).max() > ALIKE for other in others)


def _checked_tip(model: PlanningModel, group: JointGroup, tip: str) -> str:
    if not (name := tip or group.tip):
        raise InvalidLinkError(
            f"group '{group.name}' is not a chain: name the link to place; it has "
            f"{listing(group.links)}"
        )
    links = [link.name for link in model.robot.links]
    if name not in links:
        raise InvalidLinkError(f"no link '{name}'; the robot has {listing(links)}")
    return name


def _urdf_limits(robot: Robot, name: str) -> PlanningLimits:
    joint = robot.joint(name)
    if not joint.type.is_scalar:
        raise InvalidStateError(
            f"joint '{name}' is {joint.type}: its position is not a single number"
        )
    limit = joint.limit
    if limit is None:
        return PlanningLimits(-math.inf, math.inf, math.inf, math.inf)
    return PlanningLimits(limit.lower, limit.upper, limit.velocity, math.inf)


def _checked_timeout(timeout_s: float) -> float:
    if math.isnan(timeout_s):
        raise InvalidRequestError("the timeout is not a number")
    return min(timeout_s, MAX_TIMEOUT_S) if timeout_s > 0.0 else TIMEOUT_S


def _nearest_turn(angle: float, seed: float, lower: float, upper: float) -> float:
    """Return the angle plus the full turns that bring it next to a seed, inside the limits."""
    turns = round((seed - angle) / math.tau)
    if not turns:
        return angle
    for number in range(turns, 0, -1 if turns > 0 else 1):
        if lower <= (turned := angle + number * math.tau) <= upper:
            return turned
    return angle
