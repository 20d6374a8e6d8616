"""The ROS half of the joint trajectory controller: its topics, its service and its action."""

import logging
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTolerance as JointToleranceMessage
from control_msgs.msg import JointTrajectoryControllerState, SpeedScalingFactor
from control_msgs.srv import QueryTrajectoryState
from numpy.typing import NDArray
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_control.controllers.joint_trajectory.controller import JointTrajectoryController
from arm_control.controllers.joint_trajectory.goals import GoalRequest, GoalResult, JointTolerance
from arm_control.controllers.joint_trajectory.parameters import JointTrajectoryParameters
from arm_control.controllers.joint_trajectory.profiles import QUANTITIES
from arm_control.controllers.joint_trajectory.ros_serialized_goals import (
    TakenGoal,
    serializing_action_type,
    taken_goal,
)
from arm_control.controllers.joint_trajectory.serialized import (
    SerializedTrajectoryError,
    read_trajectory,
)
from arm_control.controllers.joint_trajectory.state import (
    ControllerState,
    Feedback,
    QueriedState,
    StateLayout,
)
from arm_control.controllers.joint_trajectory.trajectory import FIELDS
from arm_control.controllers.ros_action import ControllerAction
from arm_control.controllers.ros_adapter import (
    ControllerAdapter,
    duration_message,
    duration_parts,
    seconds_of,
    time_message,
)
from arm_control.errors import LoopStoppedError
from arm_control.loop.ros_executor_bridge import run_on_executor
from arm_node.workarounds.message_template import MessageTemplate

FIELD_OF_QUANTITY: dict[str, str] = dict(zip(QUANTITIES, FIELDS, strict=True))
"""The field of a JointTrajectoryPoint that holds a quantity: 'positions' for 'position'."""

PARTS = ("reference", "feedback", "error", "output")
"""Points of the message and of a `StateLayout`, in the order of `ControllerState.values`."""

TIMED_PARTS = ("reference", "feedback", "error")
"""Points of the message whose time_from_start is the trajectory's progress."""


class _JointTrajectoryStatePublisher:
    """Publishes states of one layout from a message that is serialised once. Loop thread only."""

    def __init__(self, publisher: Publisher, layout: StateLayout) -> None:
        self._publisher = publisher
        joints = len(layout.joints)
        rows = {part: getattr(layout, part) for part in PARTS}
        message = JointTrajectoryControllerState(
            joint_names=list(layout.joints),
            **{part: point_message(quantities, joints=joints) for part, quantities in rows.items()},
        )
        self._template = MessageTemplate(message)
        self._values = np.concatenate(
            [
                self._template.indices(f"{part}.{FIELD_OF_QUANTITY[quantity]}")
                for part, quantities in rows.items()
                for quantity in quantities
            ]
        )
        self._times = np.concatenate(
            [self._template.time_indices(f"{part}.time_from_start") for part in TIMED_PARTS]
        )
        self._speed_scaling = self._template.doubles("speed_scaling_factor")

    def publish(self, state: ControllerState) -> None:
        """Publish one state."""
        self._template.set_stamps(round(state.time_s * 1e9))
        self._template.float64[self._values] = state.values.ravel()
        progress = state.progress
        self._template.int32[self._times] = (
            *duration_parts(progress.reference_s),
            *duration_parts(progress.feedback_s),
            *duration_parts(progress.error_s),
        )
        self._speed_scaling[:] = state.speed_scaling
        self._template.publish(self._publisher)


class _JointTrajectoryAction(ControllerAction[JointTrajectoryController, GoalResult]):
    """The action of the joint trajectory controller, with its feedback.

    With the parameter `reject_with_reason` an invalid goal is accepted, then aborted.
    """

    def __init__(self, adapter: "JointTrajectoryAdapter") -> None:
        self._node = adapter.node
        super().__init__(adapter, serializing_action_type(), "~/follow_joint_trajectory")

    def publish_feedback(self, goal_id: bytes, layout: StateLayout, feedback: Feedback) -> None:
        """Publish a goal's feedback; loop thread."""
        handle = self.handle_of(goal_id)
        if handle is not None:
            handle.publish_feedback(feedback_message(layout, feedback))

    def accepts(self, goal: FollowJointTrajectory.Goal | TakenGoal) -> bool:
        """Return whether a goal is valid, or is accepted to be aborted with the reason."""
        refusal = self.controller.check_goal(taken_goal(goal).request)
        return refusal is None or bool(self._node.get_parameter("reject_with_reason").value)

    def submit(
        self, goal_id: bytes, goal: FollowJointTrajectory.Goal | TakenGoal
    ) -> GoalResult | None:
        """Start a goal."""
        return self.controller.submit_goal(goal_request(goal_id, taken_goal(goal)))

    def result_message(self, result: GoalResult) -> FollowJointTrajectory.Result:
        """Return the result message of a goal."""
        return result_message(result)


SPEED_SCALING_QOS = QoSProfile(
    history=HistoryPolicy.SYSTEM_DEFAULT,
    reliability=ReliabilityPolicy.SYSTEM_DEFAULT,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)


class JointTrajectoryAdapter(ControllerAdapter[JointTrajectoryController]):
    """Connects the configured controller to its topics, its service and its action.

    It is the sink of the controller, see `TrajectorySink`.
    """

    _action: _JointTrajectoryAction | None = None
    _layout: StateLayout | None = None

    def on_configure(self, parameters: JointTrajectoryParameters) -> None:
        """Create the end points."""
        self._executor = self.executor
        self._joints = parameters.joints
        self._states = self.publisher(JointTrajectoryControllerState, "~/controller_state")
        self._action = _JointTrajectoryAction(self)
        self.open(self.controller.state_layout)
        self.controller.sink = self
        self.serve(QueryTrajectoryState, "~/query_state", self._answer)
        self.subscribe(JointTrajectory, "~/joint_trajectory", self._take, raw=True)
        if self.controller.takes_speed_scaling:
            self.subscribe(
                SpeedScalingFactor, "~/speed_scaling_input", self._scale, SPEED_SCALING_QOS
            )

    def on_cleanup(self) -> None:
        """Destroy the end points after the results of all goals have been sent."""
        self.controller.sink = self._layout = None
        action, self._action = self._action, None
        if action is not None:
            action.wait_for_results()
            run_on_executor(self._executor, action.destroy)
        super().on_cleanup()

    def open(self, layout: StateLayout) -> None:
        """Serialise a message of this layout, unless that has been done.

        It takes as long as several ticks, so it is first done when the controller is configured.
        """
        if layout != self._layout:
            self._layout = layout
            self._publisher = _JointTrajectoryStatePublisher(self._states, layout)

    def publish_state(self, state: ControllerState) -> None:
        """Publish on ~/controller_state; loop thread."""
        self._publisher.publish(state)

    def publish_feedback(self, goal_id: Any, feedback: Feedback) -> None:
        """Publish the action's feedback; loop thread."""
        if self._layout is not None and self._action is not None:
            self._action.publish_feedback(goal_id, self._layout, feedback)

    def finish_goal(self, goal_id: Any, result: GoalResult) -> None:
        """Send the result to the goal's client; any thread."""
        if self._action is not None:
            self._action.finish(goal_id, result)

    def _take(self, message: bytes) -> None:
        if not self.takes_commands("~/joint_trajectory"):
            return
        try:
            request = read_trajectory(message)
        except SerializedTrajectoryError as error:
            logging.getLogger(self.controller.name).error("~/joint_trajectory: %s", error)
            return
        self.controller.submit_trajectory(request)

    def _scale(self, message: SpeedScalingFactor) -> None:
        self.controller.request_speed_scaling(message.factor)

    def _answer(
        self, request: QueryTrajectoryState.Request, response: QueryTrajectoryState.Response
    ) -> QueryTrajectoryState.Response:
        time_s = seconds_of(request.time)
        try:
            # Waits for the end of a tick: rclpy's event-driven executor runs no coroutines.
            state = self.loop.call(lambda: self.controller.query_state(time_s)).result()
        except LoopStoppedError as error:
            response.message = str(error)
            return response
        fill_query_response(response, self._joints, state)
        if not state.success:
            logging.getLogger(self.controller.name).error("query_state: %s", state.message)
        return response


def goal_request(goal_id: object, goal: TakenGoal) -> GoalRequest:
    """Return a goal in the controller's form."""
    message = goal.message
    return GoalRequest(
        id=goal_id,
        trajectory=goal.request,
        path_tolerance=_tolerances(message.path_tolerance),
        goal_tolerance=_tolerances(message.goal_tolerance),
        goal_time_tolerance_s=seconds_of(message.goal_time_tolerance),
    )


def result_message(result: GoalResult) -> FollowJointTrajectory.Result:
    """Return the result message of a goal."""
    return FollowJointTrajectory.Result(error_code=int(result.code), error_string=result.message)


def feedback_message(layout: StateLayout, feedback: Feedback) -> FollowJointTrajectory.Feedback:
    """Return the feedback message of a goal.

    Each point has an effort for every joint, as in ros2_controllers: 0 if there is none.
    """
    message = FollowJointTrajectory.Feedback(
        joint_names=list(layout.joints),
        desired=point_message(layout.reference, feedback.desired),
        actual=point_message(layout.feedback, feedback.actual),
        error=point_message(layout.error, feedback.error),
    )
    for point in (message.desired, message.actual, message.error):
        if not point.effort:
            point.effort = [0.0] * len(layout.joints)
    message.header.stamp = time_message(feedback.time_s)
    progress = feedback.progress
    message.desired.time_from_start = duration_message(progress.reference_s)
    message.actual.time_from_start = duration_message(progress.feedback_s)
    message.error.time_from_start = duration_message(progress.error_s)
    return message


def point_message(
    quantities: Sequence[str], values: NDArray[np.float64] | None = None, joints: int = 0
) -> JointTrajectoryPoint:
    """Return a waypoint.

    Args:
        quantities: 'position', 'velocity' and so on, one for each row.
        values: shape (k, n); None for zeros.
        joints: n; needed for zeros only.
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
    """Fill in the response; without a motion, as of an inactive controller, it has no names."""
    response.success = state.success
    response.message = state.message
    response.name = list(joints) if state.motion.shape[1] else []
    response.position, response.velocity, response.acceleration = state.motion.tolist()


def _tolerances(messages: Iterable[JointToleranceMessage]) -> tuple[JointTolerance, ...]:
    return tuple(
        JointTolerance(item.name, item.position, item.velocity, item.acceleration)
        for item in messages
    )
