"""The ROS half of the joint trajectory controller: its topics, its service and its action."""

import logging
from typing import Any

from control_msgs.msg import JointTrajectoryControllerState, SpeedScalingFactor
from control_msgs.srv import QueryTrajectoryState
from rclpy.publisher import Publisher
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)
from rclpy.service import Service
from rclpy.subscription import Subscription
from trajectory_msgs.msg import JointTrajectory

from arm_control.errors import LoopStoppedError
from arm_control.joint_trajectory import (
    ControllerState,
    Feedback,
    GoalResult,
    JointTrajectoryController,
    JointTrajectoryParameters,
    StateLayout,
)
from arm_control.ros.controller_adapter import ControllerAdapter
from arm_control.ros.executor_bridge import call_on_loop, run_on_executor
from arm_control.ros.joint_trajectory_action import JointTrajectoryAction
from arm_control.ros.joint_trajectory_messages import (
    fill_query_response,
    seconds_of,
    trajectory_request,
)
from arm_control.ros.joint_trajectory_state import JointTrajectoryStatePublisher

SPEED_SCALING_QOS = QoSProfile(
    history=HistoryPolicy.SYSTEM_DEFAULT,
    reliability=ReliabilityPolicy.SYSTEM_DEFAULT,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)


class JointTrajectoryAdapter(ControllerAdapter[JointTrajectoryController]):
    """Gives the controller its end points, from configure on, active or not."""

    _action: JointTrajectoryAction | None = None
    _publisher: Publisher | None = None
    _query: Service | None = None
    _subscriptions: tuple[Subscription, ...] = ()

    def on_configure(self, parameters: JointTrajectoryParameters) -> None:
        """Create the end points."""
        node, default = self.node, QoSPresetProfiles.SYSTEM_DEFAULT.value
        self._executor = self.executor
        self._joints = parameters.joints
        self._publisher = node.create_publisher(
            JointTrajectoryControllerState, "~/controller_state", default
        )
        self._action = JointTrajectoryAction(
            self.controller,
            node,
            self.loop,
            self._executor,
            lambda: bool(node.get_parameter("reject_with_reason").value),
        )
        news = JointTrajectoryNews(self._publisher, self._action)
        news.open(self.controller.state_layout)
        self.controller.sink = news
        answer: Any = self._answer  # rclpy awaits coroutines, though its annotations know none
        self._query = node.create_service(QueryTrajectoryState, "~/query_state", answer)
        self._subscriptions = (
            node.create_subscription(JointTrajectory, "~/joint_trajectory", self._take, default),
        )
        if self.controller.takes_speed_scaling:
            self._subscriptions += (
                node.create_subscription(
                    SpeedScalingFactor, "~/speed_scaling_input", self._scale, SPEED_SCALING_QOS
                ),
            )

    def on_cleanup(self) -> None:
        """Destroy the end points, once the results of all goals are out."""
        self.controller.sink = None
        if self._action is not None:
            self._action.wait_for_results()
            run_on_executor(self._executor, self._destroy)

    def _destroy(self) -> None:
        for subscription in self._subscriptions:
            self.node.destroy_subscription(subscription)
        self._subscriptions = ()
        if self._query is not None:
            self.node.destroy_service(self._query)
            self._query = None
        if self._action is not None:
            self._action.destroy()
            self._action = None
        if self._publisher is not None:
            self.node.destroy_publisher(self._publisher)
            self._publisher = None

    def _take(self, message: JointTrajectory) -> None:
        self.controller.submit_trajectory(trajectory_request(message))

    def _scale(self, message: SpeedScalingFactor) -> None:
        self.controller.request_speed_scaling(message.factor)

    async def _answer(
        self, request: QueryTrajectoryState.Request, response: QueryTrajectoryState.Response
    ) -> QueryTrajectoryState.Response:
        time_s = seconds_of(request.time)
        try:
            state = await call_on_loop(
                self.loop, lambda: self.controller.query_state(time_s), self._executor
            )
        except LoopStoppedError as error:
            response.message = str(error)
            return response
        fill_query_response(response, self._joints, state)
        if not state.success:
            logging.getLogger(self.controller.name).error("query_state: %s", state.message)
        return response


class JointTrajectoryNews:
    """Publishes what the controller tells; see `TrajectorySink`. Loop thread, but for `open`."""

    def __init__(self, publisher: Publisher, action: JointTrajectoryAction) -> None:
        self._publisher = publisher
        self._action = action
        self._layout: StateLayout | None = None
        self._states: JointTrajectoryStatePublisher | None = None

    def open(self, layout: StateLayout) -> None:
        """Serialise a message of this layout, unless that is done already.

        It takes as long as some ticks, so it is done where the controller is configured.
        """
        if layout != self._layout:
            self._layout = layout
            self._states = JointTrajectoryStatePublisher(self._publisher, layout)

    def publish_state(self, state: ControllerState) -> None:
        """Publish on ~/controller_state."""
        if self._states is not None:
            self._states.publish(state)

    def publish_feedback(self, goal_id: Any, feedback: Feedback) -> None:
        """Publish the action's feedback."""
        if self._layout is not None:
            self._action.publish_feedback(goal_id, self._layout, feedback)

    def finish_goal(self, goal_id: Any, result: GoalResult) -> None:
        """Bring the result to the goal's client."""
        self._action.finish(goal_id, result)
