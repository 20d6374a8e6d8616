"""From a request to a trajectory that is proved free: the steps of a planning pipeline.

start state -> goal states -> path -> shortcuts -> timing -> proof, and the proof decides: a
trajectory whose rounded corners come too close is timed again with tighter corners.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_planning.collision.contact import BodyKind
from arm_planning.collision.model import CollisionModel
from arm_planning.collision.motion_proof import MotionProof, Obstruction
from arm_planning.constraints.evaluation import ConstraintEvaluator
from arm_planning.errors import InvalidPlanError, MoveItErrorCode, PlanningError
from arm_planning.planners.problem import NO_DEADLINE, Deadline
from arm_planning.robot.model import JointGroup, JointPositions
from arm_planning.scene.scene import PlanningScene
from arm_planning.timing.driven_spline import DrivenSpline, chord_deviation
from arm_planning.timing.parameterize import parameterize
from arm_planning.trajectory import TimedTrajectory

Array = NDArray[np.float64]

START_TOLERANCE = 0.01
"""How far beyond a limit a start state is moved inside, rad or m: sensors are not exact."""
CORNER_TOLERANCE = 0.1
"""How far a rounded corner passes by its way point, as in TOTG, rad or m."""
TIGHTENING = 0.25
SMALLEST_CORNER = 0.002
"""Tolerance of a corner, rad or m, below which the robot stops there instead."""
RESAMPLE_DT_S = 0.1
CONSTRAINT_STEP = 5e-3
"""Largest motion of a joint between two states in which constraints are looked at, rad or m."""


@dataclass(frozen=True, slots=True)
class StartState:
    """Where a plan begins: the positions of all active joints, and a remark if they were moved."""

    positions: JointPositions
    remark: str = ""


def start_state(group: JointGroup, scene: PlanningScene) -> StartState:
    """Return the scene's state with the group's joints inside their limits.

    Raises:
        PlanningError: START_STATE_INVALID: a joint is unknown, or too far outside.
    """
    missing = [joint for joint in group.joints if joint not in scene.positions]
    if missing:
        raise PlanningError(
            MoveItErrorCode.START_STATE_INVALID,
            f"the position of joint {', '.join(missing)} is not known; is it in /joint_states?",
        )
    moved: dict[str, float] = {}
    for joint, limit in zip(group.joints, group.limits, strict=True):
        position = scene.positions[joint]
        inside = min(max(position, limit.lower), limit.upper)
        if abs(position - inside) > START_TOLERANCE:
            raise PlanningError(
                MoveItErrorCode.START_STATE_INVALID,
                f"Start state out of bounds: joint '{joint}' is at {position:.4f}, outside its "
                f"range [{limit.lower:.4f}, {limit.upper:.4f}] by {abs(position - inside):.4f}; "
                f"move it inside (up to {START_TOLERANCE:g} is corrected)",
            )
        if position != inside:
            moved[joint] = inside
    if not moved:
        return StartState(scene.positions)
    remark = ", ".join(f"'{joint}' to {value:.4f}" for joint, value in moved.items())
    return StartState(
        {**scene.positions, **moved},
        f"the start state is slightly outside of its limits; the plan moves joint {remark}",
    )


class SceneChecker:
    """Collision checks and proofs in one scene: a `StateChecker`. For one thread at a time."""

    def __init__(self, model: CollisionModel) -> None:
        self.model = model
        self.is_free, self.free_count, self.contacts = (
            model.is_free,
            model.free_count,
            model.contacts,
        )
        proof = MotionProof(model)
        self.is_free_edge, self.prove = proof.is_free_edge, proof.prove

    def prove_driven(self, trajectory: TimedTrajectory) -> Obstruction | None:
        """Return None if the points' lines and the curve that a controller drives are free."""
        return self.prove(trajectory.positions, chord_deviation(trajectory))


def check_start(checker: SceneChecker, start: Array) -> None:
    """Refuse a start from which no motion can be proved free, with advice.

    Args:
        checker: what is free.
        start: positions of the group, (n,).

    Raises:
        PlanningError: START_STATE_IN_COLLISION; the message names what touches.
    """
    touching = next(iter(checker.contacts(start)), None)
    what = str(touching)
    if touching is None:
        obstruction = checker.prove(np.vstack([start, start]))
        if obstruction is None:
            return
        touching, what = obstruction.contact, str(obstruction)
    advice = "; jog the robot away from it, or move the object"
    if touching is not None and touching.first_kind == touching.second_kind == BodyKind.ROBOT_LINK:
        advice = (
            "; if the two may touch, allow the pair in the SRDF (`arm planning srdf` finds such "
            "pairs), else jog them apart"
        )
    raise PlanningError(
        MoveItErrorCode.START_STATE_IN_COLLISION, f"the start is in collision: {what}{advice}"
    )


@dataclass(frozen=True, slots=True)
class Timing:
    """How a path is timed.

    Attributes:
        velocity_scaling: fraction of the velocity limits, (0, 1].
        acceleration_scaling: fraction of the acceleration limits, (0, 1].
    """

    velocity_scaling: float = 1.0
    acceleration_scaling: float = 1.0


def timed_and_proved(
    path: Array,
    group: JointGroup,
    checker: SceneChecker | None,
    constraints: ConstraintEvaluator,
    timing: Timing,
    corner: float = CORNER_TOLERANCE,
    deadline: Deadline = NO_DEADLINE,
) -> TimedTrajectory:
    """Return a trajectory along a path, every state of which is proved free.

    Proved are the lines between the returned points and the curve that a controller drives.

    Args:
        path: way points whose straight connections are free, (m, n).
        group: the joints.
        checker: what is free; None to prove nothing.
        constraints: what holds on the way; looked at every 5 mrad or mm of the driven curve.
        timing: speed.
        corner: how far a rounded corner may pass by its way point, rad or m.
        deadline: when the answer is due.

    Raises:
        PlanningError: INVALID_MOTION_PLAN: it cannot be made free; the message says where.
    """
    corners = np.full(len(path), corner)
    while True:
        deadline.check("timing the path")
        trajectory = parameterize(
            path,
            group.limits,
            joints=group.joints,
            velocity_scaling=timing.velocity_scaling,
            acceleration_scaling=timing.acceleration_scaling,
            path_tolerance=corner,
            resample_dt=RESAMPLE_DT_S,
            max_deviation=corners,
        )
        obstruction = None if checker is None else checker.prove_driven(trajectory)
        where = None if obstruction is None else obstruction.segment
        problem = "" if obstruction is None else str(obstruction)
        if where is None:
            where, problem = _violation(trajectory, constraints)
        if where is None:
            return trajectory
        nearby = _corners_near(path, trajectory.positions[where : where + 2])
        open_corners = [index for index in nearby if corners[index] > 0.0]
        if not open_corners:
            raise InvalidPlanError(f"the timed motion is not free: {problem}")
        corners[open_corners] *= TIGHTENING
        corners[corners < SMALLEST_CORNER] = 0.0


def _violation(
    trajectory: TimedTrajectory, constraints: ConstraintEvaluator
) -> tuple[int | None, str]:
    """Return where the driven curve violates the constraints first, and how: segment, sentence."""
    if not constraints.constraints:
        return None, ""
    spline = DrivenSpline.of(trajectory)
    moved = spline.largest(1).max(axis=1) * spline.durations_s
    looks = np.ceil(moved / CONSTRAINT_STEP).astype(int).clip(min=1)
    for segment, count in enumerate(looks):
        fractions = np.linspace(0.0, 1.0, int(count) + 1)
        for q in spline.positions_in(segment, fractions):
            if violation := constraints.violation(q):
                return segment, violation
    return None, ""


def _corners_near(path: Array, points: Array) -> list[int]:
    """Return the way points between which a part of the trajectory is, its neighbours included."""
    along = [_position_on(path, q) for q in points]
    first, last = int(np.floor(min(along))), int(np.ceil(max(along)))
    return [index for index in range(first, last + 1) if 0 < index < len(path) - 1]


def _position_on(path: Array, q: Array) -> float:
    """Return where on a polyline the nearest point to a state is: segment + fraction."""
    start, step = path[:-1], np.diff(path, axis=0)
    squared = np.maximum((step**2).sum(axis=1), 1e-30)
    fraction = np.clip(((q - start) * step).sum(axis=1) / squared, 0.0, 1.0)
    distance = np.linalg.norm(start + fraction[:, None] * step - q, axis=1)
    nearest = int(np.argmin(distance))
    return nearest + float(fraction[nearest])
