"""From messages to the requests of the joint trajectory controller, and back from its news."""

from collections.abc import Iterable, Sequence

import numpy as np
from builtin_interfaces.msg import Duration, Time
from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTolerance as JointToleranceMessage
from control_msgs.srv import QueryTrajectoryState
from numpy.typing import NDArray
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_control.joint_trajectory import (
    Feedback,
    GoalRequest,
    GoalResult,
    JointTolerance,
    QueriedState,
    StateLayout,
    TrajectoryPoint,
    TrajectoryRequest,
)
from arm_control.joint_trajectory.motion import QUANTITIES
from arm_control.joint_trajectory.requests import FIELDS
from arm_control.ros.convert import time_message

FIELD_OF_QUANTITY: dict[str, str] = dict(zip(QUANTITIES, FIELDS, strict=True))
"""The field of a JointTrajectoryPoint that holds a quantity: 'positions' for 'position'."""


SHORTEST_S, LONGEST_S = -(2.0**31), 2.0**31 - 1.0
"""What a Duration can hold."""


def seconds_of(time: Time | Duration) -> float:
    """Return a stamp or a duration in seconds; to the nanosecond where it is below some months."""
    return time.sec + time.nanosec * 1e-9


def duration_parts(time_s: float) -> tuple[int, int]:
    """Return seconds and nanoseconds of a Duration; the longest there is where it is longer."""
    nanoseconds = round(min(max(time_s, SHORTEST_S), LONGEST_S) * 1e9)
    return divmod(nanoseconds, 1_000_000_000)


def duration_message(time_s: float) -> Duration:
    """Return a time span as a message; the longest there is where it is longer."""
    seconds, nanoseconds = duration_parts(time_s)
    return Duration(sec=seconds, nanosec=nanoseconds)


def trajectory_request(message: JointTrajectory) -> TrajectoryRequest:
    """Return a trajectory as the controller takes it; the numbers stay in the message."""
    return TrajectoryRequest(
        joint_names=list(message.joint_names),
        points=[
            TrajectoryPoint(
                seconds_of(point.time_from_start),
                point.positions,
                point.velocities,
                point.accelerations,
                point.effort,
            )
            for point in message.points
        ],
        stamp_s=seconds_of(message.header.stamp),
    )


def goal_request(goal_id: object, goal: FollowJointTrajectory.Goal) -> GoalRequest:
    """Return a goal as the controller takes it."""
    return GoalRequest(
        id=goal_id,
        trajectory=trajectory_request(goal.trajectory),
        path_tolerance=_tolerances(goal.path_tolerance),
        goal_tolerance=_tolerances(goal.goal_tolerance),
        goal_time_tolerance_s=seconds_of(goal.goal_time_tolerance),
    )


def result_message(result: GoalResult) -> FollowJointTrajectory.Result:
    """Return how a goal ended."""
    return FollowJointTrajectory.Result(error_code=int(result.code), error_string=result.message)


def feedback_message(layout: StateLayout, feedback: Feedback) -> FollowJointTrajectory.Feedback:
    """Return how a goal is getting on."""
    message = FollowJointTrajectory.Feedback(
        joint_names=list(layout.joints),
        desired=point_message(layout.reference, feedback.desired),
        actual=point_message(layout.feedback, feedback.actual),
        error=point_message(layout.error, feedback.error),
    )
    message.header.stamp = time_message(feedback.time_s)
    progress = feedback.progress
    message.desired.time_from_start = duration_message(progress.reference_s)
    message.actual.time_from_start = duration_message(progress.feedback_s)
    message.error.time_from_start = duration_message(progress.error_s)
    return message


def point_message(
    quantities: Sequence[str], values: NDArray[np.float64] | None = None, joints: int = 0
) -> JointTrajectoryPoint:
    """Return a way point.

    Args:
        quantities: 'position', 'velocity' and so on, one for each row.
        values: shape (k, n); zeros where there are none yet.
        joints: n, needed for zeros only.
    """
    rows = np.zeros((len(quantities), joints)) if values is None else values
    fields = {
        FIELD_OF_QUANTITY[quantity]: row.tolist()
        for quantity, row in zip(quantities, rows, strict=True)
    }
    return JointTrajectoryPoint(**fields)


def fill_query_response(
    response: QueryTrajectoryState.Response, joints: Sequence[str], state: QueriedState
) -> None:
    """Write an answer; a controller that is not active has no motion, and so no names."""
    response.success = state.success
    response.message = state.message
    response.name = list(joints) if state.motion.shape[1] else []
    response.position, response.velocity, response.acceleration = state.motion.tolist()


def _tolerances(messages: Iterable[JointToleranceMessage]) -> tuple[JointTolerance, ...]:
    return tuple(
        JointTolerance(item.name, item.position, item.velocity, item.acceleration)
        for item in messages
    )
