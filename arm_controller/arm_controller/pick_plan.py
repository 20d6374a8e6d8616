"""Plans how the myCobot picks up an upright object from the side and puts it back.

The fingers approach horizontally at a given height, close on the object from left and right, and
move straight up. The planner chooses the direction of approach: in some directions the arm would
pass a singularity.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_controller.pose import ArmControllerError
from arm_description.errors import DescriptionError
from arm_description.transforms import transform
from arm_description.urdf.parser import parse_urdf
from arm_planning.errors import PlanningError
from arm_planning.kinematics.inverse import InverseKinematics

Array = NDArray[np.float64]

JOINTS = (
    "link1_to_link2",
    "link2_to_link3",
    "link3_to_link4",
    "link4_to_link5",
    "link5_to_link6",
    "link6_to_link6_flange",
)
"""The joints of the myCobot 280, without prefix."""
HOME = (0.0,) * len(JOINTS)
HAND = "gripper_base"
"""The link that carries the fingers: x sideways, y forward, z up."""
GRASP_CENTRE = (0.0, 0.069, -0.01)
"""The centre between the pads, 30 mm apart, in the frame of the hand (m)."""
WIDE_OPEN, OPEN, CLOSED = 0.15, 0.0, -0.7
"""Positions of the gripper (rad): 43 mm, 39 mm and 6 mm between the pads."""
HEADINGS_DEG = (-40.0, -30.0, -50.0, 25.0, 35.0, 15.0, 45.0, -20.0, 0.0)
"""Directions of the fingers relative to the direction of the object, the best first."""
POSTURES = (
    (-0.59, -2.3, 1.4, 1.0, -1.7, -0.1),
    (-1.7, -2.4, 1.75, 0.6, 0.6, 0.0),
    (-1.0, -1.0, -1.4, 2.5, -1.0, 0.0),
)
"""Starts of the inverse kinematics; the first joint is relative to the object's direction."""
APPROACH_M = 0.07
"""Length of the straight approach, which starts clear of the object."""
SWING_S, STRAIGHT_S = 3.0, 2.0
POINTS_PER_S = 10
MAX_STEP = 0.3
"""Between two points, rad or m; a larger step means that a joint passes a singularity."""


class PlanError(ArmControllerError):
    """The arm has no path for the task; the message says why."""


def prefixed_joints(prefix: str) -> list[str]:
    """Return the arm's joints, with the prefix before the names of both links of each joint."""
    return [prefix + name.replace("_to_", f"_to_{prefix}") for name in JOINTS]


@dataclass(frozen=True, slots=True)
class PathPoint:
    """Positions (rad or m) and velocities (per second) of the joints at a time.

    Attributes:
        time_s: time since the start of the path.
        positions: shape (n,).
        velocities: shape (n,), or empty: then the joints move at constant speed.
    """

    time_s: float
    positions: tuple[float, ...]
    velocities: tuple[float, ...]


JointPath = tuple[PathPoint, ...]
"""Does not contain the start: an arm starts at its current position."""


def path_to(positions: Sequence[float], duration_s: float) -> JointPath:
    """Return a path from anywhere to these positions, which it reaches at rest."""
    return (PathPoint(duration_s, tuple(positions), (0.0,) * len(positions)),)


def reversed_path(path: JointPath, start: Sequence[float]) -> JointPath:
    """Return a path in reverse; `start` are the positions before its first point."""
    duration_s = path[-1].time_s
    back = [
        PathPoint(duration_s - point.time_s, point.positions, tuple(-v for v in point.velocities))
        for point in reversed(path[:-1])
    ]
    return (*back, *path_to(start, duration_s))


def straight_path(
    kinematics: InverseKinematics, start: Sequence[float], target: Array, duration_s: float
) -> JointPath:
    """Return the path on which a link moves along a straight line without rotating.

    Args:
        kinematics: inverse kinematics of the link.
        start: positions of the joints at the start, shape (n,).
        target: the link's pose at the end, with the same orientation as at the start, shape (4, 4).
        duration_s: duration of the minimum-jerk motion.

    Raises:
        PlanningError: a point of the line is out of reach.
        PlanError: the line passes a singularity.
    """
    count = max(2, round(duration_s * POINTS_PER_S))
    times = np.linspace(0.0, 1.0, count + 1)
    shares = times**3 * (10.0 + times * (6.0 * times - 15.0))
    pose = kinematics.pose(start)
    along = target[:3, 3] - pose[:3, 3]
    joints = [np.asarray(start, dtype=float)]
    for share in shares[1:]:
        place = target.copy()
        place[:3, 3] = pose[:3, 3] + share * along
        joints.append(kinematics.solve(place, joints[-1]))
    if np.abs(np.diff(joints, axis=0)).max() > MAX_STEP:
        raise PlanError("the straight line passes a singularity")
    velocities = np.gradient(np.array(joints), duration_s / count, axis=0)
    velocities[-1] = 0.0
    return tuple(
        PathPoint(float(time * duration_s), tuple(q.tolist()), tuple(v.tolist()))
        for time, q, v in zip(times[1:], joints[1:], velocities[1:], strict=True)
    )


@dataclass(frozen=True, slots=True)
class PickTask:
    """What to pick up, and how; lengths in m.

    Attributes:
        x: position of the object, in the frame of the robot's root.
        y: position of the object, in the same frame.
        height: height of the grip, in the same frame.
        lift: how far it is lifted.
        hold_s: how long it is held there.
        max_effort: effort limit of the gripper's drive, N m.
    """

    x: float = 0.22
    y: float = 0.12
    height: float = 0.18
    lift: float = 0.10
    hold_s: float = 5.0
    max_effort: float = 1.0


@dataclass(frozen=True, slots=True)
class PickPlan:
    """The paths of one pick, in the order in which the arm follows them."""

    task: PickTask
    to_object: JointPath
    approach: JointPath
    up: JointPath
    down: JointPath
    away: JointPath
    home: JointPath


def plan_pick(description: str, task: PickTask, prefix: str = "") -> PickPlan:
    """Return the paths of a pick.

    Args:
        description: the URDF of a myCobot with its gripper.
        task: what to pick up.
        prefix: prefix of the robot's names.

    Raises:
        PlanError: the robot is not a myCobot, or the object cannot be gripped there; the message
            says why.
    """
    try:
        robot = parse_urdf(description, "robot_description")
        kinematics = InverseKinematics.for_link(robot, prefix + HAND, prefixed_joints(prefix))
    except DescriptionError as error:
        raise PlanError(str(error)) from error
    why: list[Exception] = []
    for heading, posture in _tries(task):
        try:
            return _plan(kinematics, task, heading, posture)
        except (PlanningError, PlanError) as error:
            why.append(error)
    raise PlanError(
        f"an object at ({task.x:.3f}, {task.y:.3f}) m cannot be gripped at a height of "
        f"{task.height:.3f} m and lifted by {task.lift:.3f} m: {why[0]}"
    ) from why[0]


def _tries(task: PickTask) -> Iterator[tuple[float, Sequence[float]]]:
    """Yield headings (rad) and start positions for the search, the best first."""
    direction = math.atan2(task.y, task.x)
    for turn in HEADINGS_DEG:
        for first, *others in POSTURES:
            yield direction + math.radians(turn), (direction + first, *others)


def _plan(
    kinematics: InverseKinematics, task: PickTask, heading: float, posture: Sequence[float]
) -> PickPlan:
    ahead = np.array([math.cos(heading), math.sin(heading), 0.0])
    place = np.array([task.x, task.y, task.height])
    lifted = np.array([task.x, task.y, task.height + task.lift])
    grasp = tuple(kinematics.solve(hand_at(place, ahead), posture).tolist())
    # Planned in reverse, away from the grasp, where the arm is bent most.
    away = straight_path(kinematics, grasp, hand_at(place - APPROACH_M * ahead, ahead), STRAIGHT_S)
    up = straight_path(kinematics, grasp, hand_at(lifted, ahead), STRAIGHT_S)
    return PickPlan(
        task,
        to_object=path_to(away[-1].positions, SWING_S),
        approach=reversed_path(away, grasp),
        up=up,
        down=reversed_path(up, grasp),
        away=away,
        home=path_to(HOME, SWING_S),
    )


def hand_at(place: Array, ahead: Array) -> Array:
    """Return the horizontal pose of the hand with a position between the pads."""
    up = np.array([0.0, 0.0, 1.0])
    rotation = np.column_stack([np.cross(ahead, up), ahead, up])
    return transform(rotation, place - rotation @ GRASP_CENTRE)
