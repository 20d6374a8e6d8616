"""What is sent to which controller so that joints move."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from arm_description.robot import Robot
from arm_viewer.joint_drive import JointDrive, joint_drives
from arm_viewer.requests import MoveJoints
from arm_viewer.snapshot import Snapshot

SHORTEST_S = 0.1
DEFAULT_SPEED = 1.0
"""rad/s or m/s, of a joint whose limit is not known."""
SPEED_USED = 0.8
"""Of a joint's highest speed: the rest is for speeding up and slowing down."""
NEAR = 0.05
"""rad or m: a joint that is so near to what it was told last is held there."""


@dataclass(frozen=True, slots=True)
class JointMove:
    """One message: positions in the order of the drive's joints, to be reached in a time."""

    drive: JointDrive
    positions: tuple[float, ...]
    duration_s: float


def plan_moves(snapshot: Snapshot, request: MoveJoints) -> tuple[JointMove, ...]:
    """Return the moves that bring the joints where the request wants them.

    A controller wants all its joints. The others stay: where they were told to be if they are
    about there, so that one that sags under its weight does not sink with every message, else
    where they are. A controller one of whose joints is not known gets nothing.
    """
    readings = _positions(snapshot, request.namespace)
    told = snapshot.commands.get(request.namespace, {})
    staying = {joint: _staying(told, joint, at) for joint, at in readings.items()}
    robot = _robot(snapshot, request.namespace)
    moves = []
    for drive in joint_drives(snapshot.controllers, request.namespace):
        targets = {**staying, **request.positions}
        touched = not request.positions.keys().isdisjoint(drive.joints)
        if touched and all(joint in targets for joint in drive.joints):
            positions = tuple(targets[joint] for joint in drive.joints)
            moves.append(JointMove(drive, positions, _duration_s(drive, targets, readings, robot)))
    return tuple(moves)


def _positions(snapshot: Snapshot, namespace: str) -> dict[str, float]:
    states = snapshot.joint_states.get(f"{namespace}/joint_states")
    joints = {} if states is None else states.joints
    return {name: r.position for name, r in joints.items() if math.isfinite(r.position)}


def _staying(commands: Mapping[str, float], joint: str, position: float) -> float:
    told = commands.get(f"{joint}/position", math.nan)
    return told if abs(told - position) < NEAR else position


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
    longest = SHORTEST_S
    for joint in drive.joints:
        limit = limits.get(joint)
        speed = limit.velocity if limit is not None and limit.velocity > 0.0 else DEFAULT_SPEED
        way = abs(targets[joint] - positions.get(joint, targets[joint]))
        longest = max(longest, way / (SPEED_USED * speed))
    return longest
