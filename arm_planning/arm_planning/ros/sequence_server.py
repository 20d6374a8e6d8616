"""The action sequence_move_group and the service plan_sequence_path: Pilz' sequences."""

import logging
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from moveit_msgs.action import MoveGroupSequence
from moveit_msgs.msg import MotionSequenceItem, MotionSequenceRequest, MotionSequenceResponse
from moveit_msgs.msg import PlanningScene as SceneMessage
from moveit_msgs.srv import GetMotionSequence
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_planning.errors import InvalidRequestError, MoveItErrorCode, PlanningError
from arm_planning.pipeline import start_state
from arm_planning.planner import PILZ
from arm_planning.planners.pilz.sequence import SequenceItem
from arm_planning.planners.problem import never
from arm_planning.robot.model import JointPositions, PlanningModel
from arm_planning.ros.answering import BusyLimit, offer_service
from arm_planning.ros.convert import (
    error_code,
    joint_positions,
    robot_state_message,
    trajectory_message,
)
from arm_planning.ros.goals import GoalServer, ServedGoal
from arm_planning.ros.motion_goals import MotionGoals, Plan
from arm_planning.ros.planning_session import PlanningSession, is_given
from arm_planning.ros.trajectory_executor import ExecutionOutcome
from arm_planning.scene.scene import PlanningScene
from arm_planning.trajectory import TimedTrajectory

LOGGER = logging.getLogger("move_group")


@dataclass(frozen=True, slots=True)
class SequencePlan:
    """The answer to a sequence.

    Attributes:
        code: SUCCESS, or why there are no trajectories.
        message: the reason of a failure.
        start: positions of all active joints at the start.
        trajectories: one for each run of motions of the same group; none for an empty sequence.
        planning_time_s: wall time that it took.
    """

    code: MoveItErrorCode
    message: str
    start: JointPositions
    trajectories: tuple[TimedTrajectory, ...]
    planning_time_s: float

    def message_of(self, model: PlanningModel) -> MotionSequenceResponse:
        """Return it as a message."""
        return MotionSequenceResponse(
            error_code=error_code(self.code, self.message),
            sequence_start=robot_state_message(model, self.start),
            planned_trajectories=[
                trajectory_message(model.frame, each) for each in self.trajectories
            ],
            planning_time=self.planning_time_s,
        )


class SequenceSession:
    """Plans sequences; any thread may call it."""

    def __init__(self, session: PlanningSession) -> None:
        self.session = session

    def plan(
        self,
        request: MotionSequenceRequest,
        diff: SceneMessage | None = None,
        *,
        from_present: bool = False,
        interrupted: Callable[[], bool] = never,
    ) -> SequencePlan:
        """Plan a sequence; it raises nothing for one that is not possible.

        A group's first motion may have a start state, the others none. With `from_present`, start
        states are ignored, because the robot moves at once.
        """
        started_s = time.monotonic()
        start: JointPositions = {}
        found: tuple[TimedTrajectory, ...] = ()
        code, message = MoveItErrorCode.SUCCESS, ""
        items: Sequence[MotionSequenceItem] = list(request.items)
        if not items:
            LOGGER.warning("Received empty request. That's ok but maybe not what you intended.")
        try:
            scene, message = self.session.scene_for(
                diff, from_present=from_present, interrupted=interrupted
            )
            if not from_present:
                scene = self._at_start(scene, items)
            scene = self._inside_limits(scene, items)
            start = scene.positions
            with self.session.planner() as planner:
                found = planner.sequence(self._items(scene, items), scene, interrupted)
        except PlanningError as error:
            code, message = error.code, str(error)
        return SequencePlan(code, message, start, found, time.monotonic() - started_s)

    def _at_start(self, scene: PlanningScene, items: Sequence[MotionSequenceItem]) -> PlanningScene:
        """Return the scene with the start states of each group's first motion."""
        groups: set[str] = set()
        for item in items:
            if item.req.group_name not in groups:
                scene = self.session.in_state(scene, item.req.start_state)
            groups.add(item.req.group_name)
        return scene

    def _inside_limits(
        self, scene: PlanningScene, items: Sequence[MotionSequenceItem]
    ) -> PlanningScene:
        groups = self.session.model.groups
        for name in dict.fromkeys(item.req.group_name for item in items):
            if name in groups:
                begin = start_state(groups[name], scene)
                scene = replace(scene, positions=begin.positions)
                if begin.remark:
                    LOGGER.warning("%s", begin.remark)
        return scene

    def _items(
        self, scene: PlanningScene, items: Sequence[MotionSequenceItem]
    ) -> list[SequenceItem]:
        made: list[SequenceItem] = []
        groups: set[str] = set()
        for number, item in enumerate(items):
            if item.req.pipeline_id not in ("", PILZ):
                raise InvalidRequestError(
                    f"motion {number} of the sequence is for the pipeline "
                    f"'{item.req.pipeline_id}'; a sequence is planned by '{PILZ}'"
                )
            request = self.session.request(item.req, scene)
            if is_given(item.req.start_state) and item.req.group_name in groups:
                # A later start state is passed on, so that it is refused.
                joints = joint_positions(self.session.model, item.req.start_state, LOGGER.warning)
                request = replace(request, start=joints)
            groups.add(item.req.group_name)
            made.append(SequenceItem(request, item.blend_radius))
        return made


class SequenceServer:
    """Plans sequences, and runs their trajectories one after the other."""

    def __init__(self, node: Node, motions: MotionGoals, limit: BusyLimit) -> None:
        """Offer the action and the service; several threads must spin the node.

        The limit is of the services that plan.
        """
        self._motions = motions
        self._sequences = SequenceSession(motions.session)
        self._action = GoalServer(
            node, MoveGroupSequence, "sequence_move_group", self._serve, motions.turns_of
        )
        offer_service(
            node,
            GetMotionSequence,
            "plan_sequence_path",
            self._serve_plan,
            group=ReentrantCallbackGroup(),
            limit=limit,
        )

    def _serve_plan(self, request: Any, answer: GetMotionSequence.Response) -> Any:
        plan = self._sequences.plan(request.request)
        if plan.code is not MoveItErrorCode.SUCCESS:
            LOGGER.error("%s: %s", plan.code.name, plan.message)
        self._motions.display.show(plan.start, plan.trajectories)
        answer.response = plan.message_of(self._motions.session.model)
        return answer

    def _serve(self, goal: ServedGoal, result: MoveGroupSequence.Result) -> ExecutionOutcome:
        return self._motions.serve(goal, lambda: self._plan(goal, result))

    def _plan(self, goal: ServedGoal, result: MoveGroupSequence.Result) -> Plan:
        plan = self._sequences.plan(
            goal.request.request,
            goal.request.planning_options.planning_scene_diff,
            from_present=self._motions.moves(goal.request),
            interrupted=goal.is_interrupted,
        )
        result.response = plan.message_of(self._motions.session.model)
        self._motions.display.show(plan.start, plan.trajectories)
        return ExecutionOutcome(plan.code, plan.message), plan.trajectories
