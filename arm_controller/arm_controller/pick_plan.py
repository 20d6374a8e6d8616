"""How the myCobot picks an upright object up from the side, and puts it back.

The fingers come at a height, level, close on the object from left and right, and go straight up.
From which side they come follows from the arm: not from everywhere does it get near and away
without swinging round.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_controller.errors import PlanError
from arm_controller.mycobot import GRASP_CENTRE, HAND, HOME, JOINTS
from arm_controller.straight_way import straight_way
from arm_controller.way import Way, reverse_way, way_to
from arm_description.errors import KinematicsError
from arm_description.inverse_kinematics import InverseKinematics
from arm_description.robot import Robot
from arm_description.transforms import transform

Array = NDArray[np.float64]

HEADINGS_DEG = (-40.0, -30.0, -50.0, 25.0, 35.0, 15.0, 45.0, -20.0, 0.0)
"""Where the fingers point, seen from the line from the arm to the object; the best is first."""
POSTURES = (
    (-0.59, -2.3, 1.4, 1.0, -1.7, -0.1),
    (-1.7, -2.4, 1.75, 0.6, 0.6, 0.0),
    (-1.0, -1.0, -1.4, 2.5, -1.0, 0.0),
)
"""Where to look for positions of the joints; the first counts from the object's direction."""
RUN_UP_M = 0.07
"""Distance from which the fingers come straight, clear of the object."""
SWING_S, STRAIGHT_S = 3.0, 2.0


@dataclass(frozen=True, slots=True)
class PickTask:
    """What to pick up, and how; lengths in m.

    Attributes:
        x: where the object stands, in the frame of the robot's root.
        y: likewise.
        height: at which it is gripped, likewise.
        lift: how far it is lifted.
        hold_s: how long it is held there.
        max_effort: most effort of the gripper's drive, N m.
    """

    x: float = 0.22
    y: float = 0.12
    height: float = 0.18
    lift: float = 0.10
    hold_s: float = 5.0
    max_effort: float = 1.0


@dataclass(frozen=True, slots=True)
class PickPlan:
    """The ways of one pick, in the order in which they are gone."""

    task: PickTask
    to_object: Way
    approach: Way
    up: Way
    down: Way
    away: Way
    home: Way


def plan_pick(robot: Robot, task: PickTask, prefix: str = "") -> PickPlan:
    """Return the ways of a pick.

    Args:
        robot: a myCobot with its gripper.
        task: what to pick up.
        prefix: of the robot's names.

    Raises:
        UrdfError: it is another robot.
        PlanError: the object cannot be gripped there; says why.
    """
    kinematics = InverseKinematics(robot, prefix + HAND, [prefix + name for name in JOINTS])
    why: list[Exception] = []
    for heading, posture in _tries(task):
        try:
            return _plan(kinematics, task, heading, posture)
        except (KinematicsError, PlanError) as error:
            why.append(error)
    raise PlanError(
        f"an object at ({task.x:.3f}, {task.y:.3f}) m cannot be gripped at a height of "
        f"{task.height:.3f} m and lifted by {task.lift:.3f} m: {why[0]}"
    ) from why[0]


def _tries(task: PickTask) -> Iterator[tuple[float, Sequence[float]]]:
    """Yield headings (rad) and postures to start the search from, the best first."""
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
    grasp = tuple(kinematics.solve(_hand_at(place, ahead), posture).tolist())
    # Planned away from the grasp, where the arm is stretched least.
    away = straight_way(kinematics, grasp, _hand_at(place - RUN_UP_M * ahead, ahead), STRAIGHT_S)
    up = straight_way(kinematics, grasp, _hand_at(lifted, ahead), STRAIGHT_S)
    return PickPlan(
        task,
        to_object=way_to(away[-1].positions, SWING_S),
        approach=reverse_way(away, grasp),
        up=up,
        down=reverse_way(up, grasp),
        away=away,
        home=way_to(HOME, SWING_S),
    )


def _hand_at(place: Array, ahead: Array) -> Array:
    """Return the pose of the hand, level, with a place between the pads."""
    up = np.array([0.0, 0.0, 1.0])
    rotation = np.column_stack([np.cross(ahead, up), ahead, up])
    return transform(rotation, place - rotation @ GRASP_CENTRE)
