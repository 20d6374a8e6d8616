"""Converts poses, robot states and trajectories from and to messages; units are the same."""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from builtin_interfaces.msg import Duration, Time
from geometry_msgs.msg import Point, Pose, Quaternion, Transform, Vector3
from moveit_msgs.msg import MoveItErrorCodes, RobotState, RobotTrajectory
from trajectory_msgs.msg import JointTrajectoryPoint

from arm_node.names import describe_known, listing
from arm_node.rigid_transform import RigidTransform, Vector
from arm_planning.errors import (
    InvalidPlanError,
    InvalidRequestError,
    InvalidStateError,
    MoveItErrorCode,
)
from arm_planning.kinematics.inverse import FARTHEST
from arm_planning.robot.model import JointPositions, PlanningModel
from arm_planning.scene.object_checks import rotation_problem, vector_problem
from arm_planning.trajectory import TimedTrajectory

NANOSECONDS = 1_000_000_000

Warn = Callable[[str], None]
"""Takes a sentence for the user about something that is passed over."""


def error_code(code: MoveItErrorCode, message: str = "") -> MoveItErrorCodes:
    """Return an error code with its reason."""
    return MoveItErrorCodes(val=int(code), message=message, source="move_group" if message else "")


def vector_of(message: Point | Vector3, what: str) -> Vector:
    """Return a point or vector.

    Raises:
        PlanningError: a coordinate is not finite, or too large; `what` names the vector.
    """
    vector = (message.x, message.y, message.z)
    if problem := vector_problem(vector, what):
        raise InvalidRequestError(problem)
    return vector


def pose_of(message: Pose, what: str) -> RigidTransform:
    """Return a pose with a unit quaternion.

    Raises:
        PlanningError: a number is not finite, or the quaternion is zero; `what` names the pose.
    """
    position = vector_of(message.position, f"the position of {what}")
    return RigidTransform(position, quaternion_of(message.orientation, what))


def transform_of(message: Transform, what: str) -> RigidTransform:
    """Return a transform as a pose; raises like `pose_of`."""
    position = vector_of(message.translation, f"the position of {what}")
    return RigidTransform(position, quaternion_of(message.rotation, what))


def quaternion_of(message: Quaternion, what: str) -> tuple[float, float, float, float]:
    """Return a unit quaternion.

    Raises:
        PlanningError: a number is not finite, or the norm is not 1; `what` names the pose.
    """
    numbers = (message.x, message.y, message.z, message.w)
    if problem := rotation_problem(numbers, what):
        raise InvalidRequestError(problem)
    norm = math.hypot(*numbers)
    x, y, z, w = (number / norm for number in numbers)
    return (x, y, z, w)


def pose_message(pose: RigidTransform) -> Pose:
    """Return a pose as a message."""
    x, y, z = map(float, pose.position)
    i, j, k, w = map(float, pose.rotation)
    return Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=i, y=j, z=k, w=w))


def vector_message(vector: Iterable[float]) -> Vector3:
    """Return a vector as a message."""
    x, y, z = map(float, vector)
    return Vector3(x=x, y=y, z=z)


def seconds(duration: Duration | Time) -> float:
    """Return a duration or a time in s."""
    return duration.sec + duration.nanosec / NANOSECONDS


def duration_message(time_s: float) -> Duration:
    """Return a duration as a message, rounded to whole nanoseconds."""
    sec, nanosec = divmod(round(time_s * NANOSECONDS), NANOSECONDS)
    return Duration(sec=sec, nanosec=nanosec)


def stamp_message(time_s: float) -> Time:
    """Return a time as a message, rounded to whole nanoseconds."""
    sec, nanosec = divmod(round(time_s * NANOSECONDS), NANOSECONDS)
    return Time(sec=sec, nanosec=nanosec)


def joint_positions(model: PlanningModel, message: RobotState, warn: Warn) -> dict[str, float]:
    """Return the positions of active joints in a state; other joints are passed over.

    Clients forward every name on /joint_states, so a joint that is not the robot's only warns.

    Raises:
        PlanningError: INVALID_ROBOT_STATE: a position is not finite, or too large.
    """
    names, values = list(message.joint_state.name), list(message.joint_state.position)
    if len(names) != len(values):
        warn(
            "Different number of names and positions in JointState message: "
            f"{len(names)}, {len(values)}"
        )
        return {}
    result: dict[str, float] = {}
    known = {joint.name for joint in model.robot.joints}
    for name, value in zip(names, values, strict=True):
        if name not in known:
            unknown = describe_known(name, known, "the robot has")
            warn(f"a state names the joint '{name}', which the robot does not have; {unknown}")
        elif not abs(value) <= FARTHEST:
            raise InvalidStateError(f"the position of joint '{name}' is {value}")
        elif name in model.joints:
            result[name] = value
    return result


def robot_state_message(model: PlanningModel, positions: JointPositions) -> RobotState:
    """Return a state with the positions of all joints, mimic joints included."""
    state = RobotState()
    names: list[str] = []
    values: list[float] = []
    for joint in model.robot.joints_in_tree_order:
        if joint.type.is_scalar:
            rule = model.robot.leader_of(joint.name)
            names.append(joint.name)
            values.append(rule.position(positions.get(rule.joint, 0.0)))
    state.joint_state.header.frame_id = model.frame
    state.joint_state.name = names
    state.joint_state.position = values
    return state


def trajectory_message(frame: str, trajectory: TimedTrajectory | None) -> RobotTrajectory:
    """Return a trajectory as a message; without one, an empty message."""
    message = RobotTrajectory()
    if trajectory is None:
        return message
    joint_trajectory = message.joint_trajectory
    joint_trajectory.header.frame_id = frame
    joint_trajectory.joint_names = list(trajectory.joints)
    joint_trajectory.points = [
        JointTrajectoryPoint(
            positions=position,
            velocities=velocity,
            accelerations=acceleration,
            time_from_start=duration_message(time_s),
        )
        for position, velocity, acceleration, time_s in zip(
            trajectory.positions.tolist(),
            trajectory.velocities.tolist(),
            trajectory.accelerations.tolist(),
            trajectory.times_s.tolist(),
            strict=True,
        )
    ]
    return message


def trajectory_of(message: RobotTrajectory) -> TimedTrajectory:
    """Return a trajectory; velocities and accelerations that a point lacks are NaN.

    Raises:
        PlanningError: INVALID_MOTION_PLAN: a joint is named twice, a point has a wrong number of
            values, a value is not finite, its time does not increase, or there is a part for joints
            of several degrees of freedom.
    """
    given = message.joint_trajectory
    count = len(given.joint_names)
    if repeated := [name for name, times in Counter(given.joint_names).items() if times > 1]:
        raise InvalidPlanError(f"the trajectory names {listing(repeated)} more than once")
    if message.multi_dof_joint_trajectory.points:
        raise InvalidPlanError(
            "the trajectory has a multi_dof_joint_trajectory, which no controller here follows"
        )
    points: list[Any] = list(given.points)
    for number, point in enumerate(points):
        sizes = {len(point.velocities), len(point.accelerations)} - {0}
        if len(point.positions) != count or not sizes <= {count}:
            raise InvalidPlanError(
                f"point {number} of the trajectory has {len(point.positions)} positions for "
                f"{count} joints"
            )
    times = np.array([seconds(point.time_from_start) for point in points])
    if (np.diff(times) <= 0.0).any():
        number = int(np.argmax(np.diff(times) <= 0.0)) + 1
        raise InvalidPlanError(
            f"point {number} of the trajectory is not later than the point before it"
        )
    return TimedTrajectory(
        tuple(given.joint_names),
        times,
        *(_values(points, name, count) for name in ("positions", "velocities", "accelerations")),
    )


def _values(points: Sequence[Any], name: str, count: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    given = [list(getattr(point, name)) for point in points]
    for number, row in enumerate(given):
        if not all(map(math.isfinite, row)):
            raise InvalidPlanError(
                f"point {number} of the trajectory has {name} that are not finite: "
                + ", ".join(map(str, row))
            )
    missing = [math.nan] * count
    return np.array([row or missing for row in given]).reshape(len(points), count)
