"""Plan joint moves: find the controllers and compute the commands for them."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum

from arm_description.urdf.robot import Robot
from arm_viewer.requests import MoveJoints
from arm_viewer.snapshot import ListedController, Snapshot

POSITION = "/position"


class DriveKind(Enum):
    """The input of a controller: its topic or action below the controller's name, and its type."""

    POSITIONS = "commands", "std_msgs/msg/Float64MultiArray"
    POSITION = "command", "std_msgs/msg/Float64"
    TRAJECTORY = "joint_trajectory", "trajectory_msgs/msg/JointTrajectory"
    GRIPPER = "gripper_cmd", "control_msgs/action/GripperCommand"
    PARALLEL_GRIPPER = "gripper_cmd", "control_msgs/action/ParallelGripperCommand"


KINDS = {
    "JointGroupPositionController": DriveKind.POSITIONS,
    "ForwardCommandController": DriveKind.POSITIONS,
    "JointPositionController": DriveKind.POSITION,
    "JointTrajectoryController": DriveKind.TRAJECTORY,
    "GripperActionController": DriveKind.GRIPPER,
}
"""The drive kind by the class name in a controller's type."""
PARALLEL_GRIPPER_TYPE = "parallel_gripper_action_controller/GripperActionController"
"""Has the same class name as another type, but takes other goals."""


@dataclass(frozen=True, slots=True)
class JointDrive:
    """An active controller that accepts joint positions.

    Attributes:
        controller: name of the controller.
        name: absolute name of its topic or action.
        kind: kind of input.
        joints: the joints in the order of the message.
    """

    controller: str
    name: str
    kind: DriveKind
    joints: tuple[str, ...]


def joint_drives(controllers: Iterable[ListedController], namespace: str) -> tuple[JointDrive, ...]:
    """Return the drives of the robot in a namespace; each joint has at most one.

    Controllers claim command interfaces exclusively, so no two active ones share a joint.
    """
    drives = []
    for controller in controllers:
        kind = _kind(controller)
        if kind is None or controller.namespace != namespace or controller.state != "active":
            continue
        joints = _joints(controller, kind)
        if joints:
            name = f"{namespace}/{controller.name}/{kind.value[0]}"
            drives.append(JointDrive(controller.name, name, kind, joints))
    return tuple(drives)


def _kind(controller: ListedController) -> DriveKind | None:
    if controller.type == PARALLEL_GRIPPER_TYPE:
        return DriveKind.PARALLEL_GRIPPER
    return KINDS.get(controller.type.rpartition("/")[2])


def _joints(controller: ListedController, kind: DriveKind) -> tuple[str, ...]:
    """Return the joints whose positions a controller takes; empty if it needs other commands."""
    if kind in (DriveKind.GRIPPER, DriveKind.PARALLEL_GRIPPER):
        # The joint's position or effort interface comes first, then its limiting interfaces.
        return tuple(name.rpartition("/")[0] for name in controller.claimed[:1])
    if not all(name.endswith(POSITION) for name in controller.claimed):
        return ()
    claimed = tuple(name.removesuffix(POSITION) for name in controller.claimed)
    return controller.joints if set(controller.joints) == set(claimed) else claimed


MIN_DURATION_S = 0.1
DEFAULT_SPEED = 1.0
"""Speed in rad/s or m/s of a joint whose limit is unknown."""
SPEED_USED = 0.8
"""Fraction of a joint's speed limit that is used; the rest allows for acceleration."""
NEAR = 0.05
"""A joint within this distance of its last command, in rad or m, is held at that command."""


@dataclass(frozen=True, slots=True)
class JointMove:
    """One command: positions in the order of the drive's joints, and the time to reach them."""

    drive: JointDrive
    positions: tuple[float, ...]
    duration_s: float


def plan_moves(snapshot: Snapshot, request: MoveJoints) -> tuple[JointMove, ...]:
    """Return the moves that bring the joints to the requested positions.

    A controller needs a position for each of its joints. Joints that are not requested hold: at
    their last command if they are close to it, so that a joint that sags under its weight does not
    sink with every message, and otherwise at their present position. A controller with an unknown
    joint gets no command.
    """
    readings = snapshot.positions(request.namespace)
    commands = snapshot.commands.get(request.namespace, {})
    held = {joint: _hold_position(commands, joint, at) for joint, at in readings.items()}
    robot = _robot(snapshot, request.namespace)
    moves = []
    for drive in joint_drives(snapshot.controllers, request.namespace):
        targets = {**held, **request.positions}
        requested = not request.positions.keys().isdisjoint(drive.joints)
        if requested and all(joint in targets for joint in drive.joints):
            positions = tuple(targets[joint] for joint in drive.joints)
            moves.append(JointMove(drive, positions, _duration_s(drive, targets, readings, robot)))
    return tuple(moves)


def _hold_position(commands: Mapping[str, float], joint: str, position: float) -> float:
    command = commands.get(f"{joint}/position", math.nan)
    return command if abs(command - position) < NEAR else position


def _robot(snapshot: Snapshot, namespace: str) -> Robot | None:
    description = snapshot.descriptions.get(f"{namespace}/robot_description")
    return None if description is None else description.robot


def _duration_s(
    drive: JointDrive,
    targets: Mapping[str, float],
    positions: Mapping[str, float],
    robot: Robot | None,
) -> float:
    limits = {} if robot is None else {joint.name: joint.limit for joint in robot.joints}
    longest = MIN_DURATION_S
    for joint in drive.joints:
        limit = limits.get(joint)
        speed = limit.velocity if limit is not None and limit.velocity > 0.0 else DEFAULT_SPEED
        distance = abs(targets[joint] - positions.get(joint, targets[joint]))
        longest = max(longest, distance / (SPEED_USED * speed))
    return longest
