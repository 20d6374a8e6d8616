"""Straight paths of a link through way points, as far as they go, with the reason where they stop.

The rules are those of MoveIt's compute_cartesian_path: steps of at most `max_step_m`, halved where
the link would leave the line between two of them. Unlike there, thresholds of joint jumps act, and
the motion between the points counts, not the points alone.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import InvalidRequestError, PlanningError
from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.kinematics.pose_target import checked_pose
from arm_planning.kinematics.search import Orientation
from arm_planning.planners.pose_line import PoseLine
from arm_planning.planners.problem import StateChecker

Array = NDArray[np.float64]

RAD_PER_M = 3.5
"""A step turns by at most this times `max_step_m`, as in MoveIt: 2 degrees for 10 mm."""
OFF_LINE_M, OFF_LINE_RAD = 1e-3, 1e-2
"""How far the link may be off the line half way between two points."""
SMALLEST_STEP = 1e-5
"""Share of the way to a way point below which a step is not halved any more."""
SMALLEST_REACHING_STEP = 1e-3
"""The same for a step whose end is out of reach."""
MAX_POINTS = 20_000
MIN_POINTS_FOR_FACTOR = 10
"""Points that a path needs for `JumpLimits.factor`, as in MoveIt."""
CONTACT_SAMPLES = 9
"""States between two points at which contacts are looked for, to name one."""


@dataclass(frozen=True, slots=True)
class JumpLimits:
    """How far joints may move between two points; 0 switches a limit off.

    Attributes:
        factor: of the mean distance between points; counts for paths of ten points or more.
        turning_rad: of a turning joint.
        sliding_m: of a sliding joint.
    """

    factor: float = 0.0
    turning_rad: float = 0.0
    sliding_m: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class CartesianPath:
    """What was found of a path.

    Attributes:
        points: positions of the group, (m, n); the first is the start.
        fraction: share of the way points that is reached, with part of the next, 0 to 1.
        stopped: why and where it stops; "" for a whole path.
    """

    points: Array
    fraction: float
    stopped: str = ""


class _Stop(Exception):
    """The end of a path before its last way point; the message is the reason."""


def cartesian_path(
    kinematics: InverseKinematics,
    start: Array,
    way_points: Sequence[RigidTransform],
    max_step_m: float,
    *,
    relative: bool = False,
    orientation: Orientation = Orientation.EXACT,
    jumps: JumpLimits = JumpLimits(),
    checker: StateChecker | None = None,
    violation: Callable[[Array], str] | None = None,
) -> CartesianPath:
    """Return the path of a group on which its link moves straight from way point to way point.

    Args:
        kinematics: inverse kinematics of the group and the link.
        start: positions of the group, (n,).
        way_points: poses of the link in the planning frame.
        max_step_m: distance between two points at most.
        relative: whether each way point is in the frame of the link at the way point before it.
        orientation: what the points owe to the orientation on the way.
        jumps: limits of what joints move between two points.
        checker: what is free of collisions; None to ignore collisions.
        violation: says how a state, (n,), violates the path constraints, "" if it does not.

    Raises:
        PlanningError: FAILURE or INVALID_GOAL_CONSTRAINTS: the step is not positive, the path has
            too many points, or a way point is no pose. INVALID_ROBOT_STATE: the start is no state.
    """
    start = kinematics.checked(start)
    lines = _lines(kinematics.tip_pose(start), way_points, relative)
    counts = _counts(lines, max_step_m)
    path = _Path(kinematics, start, orientation, checker, violation)
    stopped = ""
    try:
        for number, (line, count) in enumerate(zip(lines, counts, strict=True)):
            path.extend(line, count, number)
    except _Stop as stop:
        stopped = _sentence(kinematics.tip, lines, path.shares[-1], stop)
    points = np.array(path.points)
    for before, reason in _jumps(kinematics, points, jumps):
        share = path.shares[before]
        stopped = _sentence(kinematics.tip, lines, share, reason)
        return CartesianPath(points[: before + 1], share / len(lines), stopped)
    return CartesianPath(points, path.shares[-1] / max(len(lines), 1), stopped)


def _lines(
    start: RigidTransform, way_points: Sequence[RigidTransform], relative: bool
) -> list[PoseLine]:
    lines: list[PoseLine] = []
    for number, way_point in enumerate(way_points, 1):
        try:
            (px, py, pz), (w, x, y, z) = (part.tolist() for part in checked_pose(way_point))
        except PlanningError as error:
            message = f"way point {number} of {len(way_points)}: {error}"
            raise PlanningError(error.code, message) from error
        end = RigidTransform((px, py, pz), (x, y, z, w))
        lines.append(PoseLine(start, start.then(end) if relative else end))
        start = lines[-1].end
    return lines


def _counts(lines: list[PoseLine], max_step_m: float) -> list[int]:
    """Return the number of steps of each line."""
    if not max_step_m > 0.0 or math.isinf(max_step_m):
        raise InvalidRequestError(f"max_step is {max_step_m:g} m; it must be positive")
    shares = [max(line.length_m, line.angle_rad / RAD_PER_M) / max_step_m for line in lines]
    if sum(shares) > MAX_POINTS:
        raise InvalidRequestError(
            f"steps of {max_step_m:g} m make {sum(shares):.0f} points of this path; "
            f"{MAX_POINTS} are possible"
        )
    return [math.floor(share) + 1 for share in shares]


class _Path:
    """A path that grows; `shares` are the way points passed at each point, and a part."""

    def __init__(
        self,
        kinematics: InverseKinematics,
        start: Array,
        orientation: Orientation,
        checker: StateChecker | None,
        violation: Callable[[Array], str] | None,
    ) -> None:
        self._kinematics, self._orientation = kinematics, orientation
        self._checker, self._violation = checker, violation
        self.points, self.shares = [start], [0.0]

    def extend(self, line: PoseLine, count: int, number: int) -> None:
        """Go to the end of a line in steps, or raise `_Stop` where it does not go on."""
        ends = [step / count for step in range(count, 0, -1)]
        while ends:
            here = max(self.shares[-1] - number, 0.0)
            q, reason, smallest = self._step(line, here, ends[-1])
            if reason:
                if ends[-1] - here < smallest:
                    raise _Stop(reason)
                ends.append((here + ends[-1]) / 2.0)
                continue
            self._check(self.points[-1], q)
            self.points.append(q)
            self.shares.append(number + ends.pop())
            if len(self.points) > 2 * MAX_POINTS:
                raise _Stop(f"the path has more than {2 * MAX_POINTS} points")

    def _step(self, line: PoseLine, here: float, there: float) -> tuple[Array, str, float]:
        """Return the next point; or why it is none, and the step from which that counts."""
        last = self.points[-1]
        try:
            q = self._kinematics.follow(line.at(there), last, orientation=self._orientation)
        except PlanningError as error:
            return last, str(error), SMALLEST_REACHING_STEP
        off = PoseLine(self._kinematics.tip_pose((last + q) / 2.0), line.at((here + there) / 2.0))
        is_turned = self._orientation is Orientation.EXACT and off.angle_rad > OFF_LINE_RAD
        if off.length_m <= OFF_LINE_M and not is_turned:
            return q, "", 0.0
        joint, change = self._largest_change(last, q)
        return q, f"joint '{joint}' would have to jump by {change}", SMALLEST_STEP

    def _largest_change(self, a: Array, b: Array) -> tuple[str, str]:
        index = int(np.abs(b - a).argmax())
        return self._kinematics.group.joints[index], f"{b[index] - a[index]:.3g}"

    def _check(self, last: Array, q: Array) -> None:
        if self._checker is not None and not self._checker.is_free_edge(last, q):
            raise _Stop(_contact(self._checker, last, q))
        if self._violation is not None and (sentence := self._violation(q)):
            raise _Stop(sentence)


def _contact(checker: StateChecker, a: Array, b: Array) -> str:
    """Return what touches between two points."""
    for share in np.linspace(0.0, 1.0, CONTACT_SAMPLES):
        if contacts := checker.contacts(a + share * (b - a)):
            return f"there is a collision: {contacts[0]}"
    return "the next step is not proved free of collisions"


def _jumps(
    kinematics: InverseKinematics, points: Array, jumps: JumpLimits
) -> Iterator[tuple[int, str]]:
    """Yield the index of the point before each jump, and the reason to stop there."""
    changes = np.abs(np.diff(points, axis=0))
    thresholds = np.where(kinematics.turning, jumps.turning_rad, jumps.sliding_m)
    thresholds = np.where(thresholds > 0.0, thresholds, math.inf)
    distances = np.linalg.norm(changes, axis=1)
    uses_factor = jumps.factor > 0.0 and len(points) >= MIN_POINTS_FOR_FACTOR
    longest = jumps.factor * float(distances.mean()) if uses_factor else math.inf
    for index, change in enumerate(changes):
        joint = int((change / thresholds).argmax())
        if change[joint] > thresholds[joint]:
            why = f"the threshold is {thresholds[joint]:g}"
        elif distances[index] > longest:
            joint = int(change.argmax())
            why = f"that is {distances[index] / distances.mean():.1f} times the mean of the steps"
        else:
            continue
        name = kinematics.group.joints[joint]
        yield index, f"joint '{name}' would move by {change[joint]:.3g} in one step; {why}"


def _sentence(tip: str, lines: list[PoseLine], share: float, reason: object) -> str:
    """Say where a path stops that has passed a number of way points, and part of a line."""
    number = min(int(share), len(lines) - 1)
    line, part = lines[number], share - number
    x, y, z = line.at(part).position
    return (
        f"link '{tip}' stops at {100.0 * share / len(lines):.1f} % of the path, "
        f"{(1.0 - part) * line.length_m * 1e3:.1f} mm before way point {number + 1} of "
        f"{len(lines)}, at ({x:.3f}, {y:.3f}, {z:.3f}) m: {reason}"
    )
