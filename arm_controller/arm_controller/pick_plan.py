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

from arm_controller.errors import PlanError
from arm_controller.joint_path import JointPath, path_to, reversed_path, straight_path
from arm_controller.mycobot import GRASP_CENTRE, HAND, HOME, prefixed_joints
from arm_description.errors import KinematicsError
from arm_description.kinematics.inverse import InverseKinematics
from arm_description.transforms import transform
from arm_description.urdf.robot import Robot

Array = NDArray[np.float64]

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


def plan_pick(robot: Robot, task: PickTask, prefix: str = "") -> PickPlan:
    """Return the paths of a pick.

    Args:
        robot: a myCobot with its gripper.
        task: what to pick up.
        prefix: prefix of the robot's names.

    Raises:
        UrdfError: the robot is not a myCobot.
        PlanError: the object cannot be gripped there; the message says why.
    """
    kinematics = InverseKinematics(robot, prefix + HAND, prefixed_joints(prefix))
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
    grasp = tuple(kinematics.solve(_hand_at(place, ahead), posture).tolist())
    # Planned in reverse, away from the grasp, where the arm is bent most.
    away = straight_path(kinematics, grasp, _hand_at(place - APPROACH_M * ahead, ahead), STRAIGHT_S)
    up = straight_path(kinematics, grasp, _hand_at(lifted, ahead), STRAIGHT_S)
    return PickPlan(
        task,
        to_object=path_to(away[-1].positions, SWING_S),
        approach=reversed_path(away, grasp),
        up=up,
        down=reversed_path(up, grasp),
        away=away,
        home=path_to(HOME, SWING_S),
    )


def _hand_at(place: Array, ahead: Array) -> Array:
    """Return the horizontal pose of the hand with a position between the pads."""
    up = np.array([0.0, 0.0, 1.0])
    rotation = np.column_stack([np.cross(ahead, up), ahead, up])
    return transform(rotation, place - rotation @ GRASP_CENTRE)
