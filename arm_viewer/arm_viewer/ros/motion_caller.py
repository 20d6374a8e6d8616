"""Plans and executes motions of one move_group, and shows the plans of other programs."""

from collections.abc import Sequence
from typing import Any

from moveit_msgs.action import ExecuteTrajectory, MoveGroup
from moveit_msgs.msg import DisplayTrajectory, MoveItErrorCodes, RobotState, RobotTrajectory
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import String

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.convert import joint_positions, trajectory_of
from arm_planning.ros.goal_messages import joint_goal, move_goal, plan_message
from arm_viewer.planned_path import PlannedPath, planned_path
from arm_viewer.planning import Activity, GoalState, ShownPlan
from arm_viewer.requests import PlanMotion
from arm_viewer.ros.action_caller import ActionCaller
from arm_viewer.ros.topic_reader import TopicReader

PLANNING_TIME_S = 5.0
"""MoveIt's default."""
EXTRA_TIME_S = 10.0
"""How much longer a plan may take to arrive: move_group may serve others first."""
STOP = "stop"
NO_GOAL = "Choose a goal first: a named pose, or drag the tip."
NO_PLAN = "There is no plan to execute; plan first."
BUSY = "move_group is still at work; stop it first."
ARRIVED = "The robot has arrived."
_QUEUE = 10


class MotionCaller:
    """Use it in the executor's thread.

    Attributes:
        activity: what move_group does for the page.
        said: what the last plan or motion led to.
        failed: whether `said` is about a failure.
        plan: the latest plan; None if there is none.
    """

    def __init__(
        self, node: Node, polled: PolledSubscriptions, namespace: str, model: PlanningModel
    ) -> None:
        """Create the clients."""
        self.activity = Activity.NONE
        self.said, self.failed = "", False
        self.plan: ShownPlan | None = None
        self._node = node
        self._model = model
        self._trajectory: RobotTrajectory | None = None
        self._move = ActionCaller(node, MoveGroup, f"{namespace}/move_action")
        self._execute = ActionCaller(node, ExecuteTrajectory, f"{namespace}/execute_trajectory")
        self._displayed: TopicReader[DisplayTrajectory] = TopicReader(
            node,
            polled,
            DisplayTrajectory,
            f"{namespace}/display_planned_path",
            QoSProfile(depth=_QUEUE),
        )
        self._event = node.create_publisher(
            String, f"{namespace}/trajectory_execution_event", _QUEUE
        )

    def collect(self) -> None:
        """Take plans that have been displayed."""
        for message in self._displayed.take_all():
            path = self._path(message.trajectory_start, list(message.trajectory))
            if path is not None and not (self.plan is not None and path.is_same(self.plan.path)):
                own = self._move.is_busy
                self.plan = ShownPlan(path, own)
                self._trajectory = None

    def check(self) -> None:
        """End what is late; call it periodically."""
        self._move.check()
        self._execute.check()

    def start(self, goal: GoalState | None, request: PlanMotion) -> None:
        """Plan to a goal, and execute the plan if the request says so."""
        if goal is None:
            self._say(NO_GOAL, failed=True)
        elif self._is_busy():
            self._say(BUSY, failed=True)
        else:
            self.plan = self._trajectory = None
            self._begin(Activity.MOVING if request.executes else Activity.PLANNING)
            executes = request.executes
            self._move.start(
                _move_goal(goal, request),
                lambda result, problem: self._take_plan(result, problem, executes),
                float("inf") if executes else PLANNING_TIME_S + EXTRA_TIME_S,
            )

    def execute(self) -> None:
        """Execute the latest plan of this page."""
        if self._is_busy():
            self._say(BUSY, failed=True)
        elif self._trajectory is None:
            self._say(NO_PLAN, failed=True)
        else:
            self._begin(Activity.MOVING)
            self._execute.start(
                ExecuteTrajectory.Goal(trajectory=self._trajectory), self._take_execution
            )

    def stop(self) -> None:
        """Cancel what this page asked for, and stop every motion that move_group executes."""
        self._move.cancel()
        self._execute.cancel()
        self._event.publish(String(data=STOP))

    def refuse(self, sentence: str) -> None:
        """Say why nothing is planned."""
        self._say(sentence, failed=True)

    def drop_plan(self) -> None:
        """Forget the plan: it leads to another goal."""
        if not self._is_busy():
            self.plan = self._trajectory = None
            self._say("")

    def close(self) -> None:
        """Destroy the clients."""
        self._move.close()
        self._execute.close()
        self._displayed.close()
        self._node.destroy_publisher(self._event)

    def _is_busy(self) -> bool:
        return self._move.is_busy or self._execute.is_busy

    def _begin(self, activity: Activity) -> None:
        self.activity = activity
        self._say("")

    def _say(self, sentence: str, failed: bool = False) -> None:
        self.said, self.failed = sentence, failed

    def _take_plan(self, result: MoveGroup.Result | None, problem: str, executes: bool) -> None:
        self.activity = Activity.NONE
        if result is None:
            # What was displayed meanwhile cannot be executed.
            self.plan = None
            self._say(problem, failed=True)
            return
        path = self._path(result.trajectory_start, [result.planned_trajectory])
        if path is not None:
            self.plan = ShownPlan(path, True, result.planning_time)
            self._trajectory = result.planned_trajectory
        failure = _failure(result.error_code)
        if failure:
            self._say(failure, failed=True)
        elif executes:
            self._say(ARRIVED)
        elif path is None:
            self._say("The robot is at the goal already.")

    def _take_execution(self, result: ExecuteTrajectory.Result | None, problem: str) -> None:
        self.activity = Activity.NONE
        failure = problem if result is None else _failure(result.error_code)
        self._say(failure or ARRIVED, failed=bool(failure))

    def _path(self, start: RobotState, motions: Sequence[RobotTrajectory]) -> PlannedPath | None:
        try:
            positions = joint_positions(self._model, start, lambda _: None)
            return planned_path(self._model, positions, [trajectory_of(each) for each in motions])
        except PlanningError as error:
            self._say(f"The plan cannot be shown: {error}", failed=True)
            return None


def _move_goal(goal: GoalState, request: PlanMotion) -> MoveGroup.Goal:
    asked = plan_message(
        goal.group,
        joint_goal(goal.positions),
        num_planning_attempts=1,
        allowed_planning_time=PLANNING_TIME_S,
        max_velocity_scaling_factor=request.velocity,
        max_acceleration_scaling_factor=request.acceleration,
    )
    return move_goal(asked, plan_only=not request.executes)


def _failure(code: Any) -> str:
    """Return why something failed, in full; empty if it succeeded."""
    if code.val == MoveItErrorCodes.SUCCESS:
        return ""
    try:
        name = MoveItErrorCode(code.val).name
    except ValueError:
        name = str(code.val)
    return f"{code.message or 'move_group has failed'} ({name})"
