"""Plans requests in messages: in the present scene, with its changes, from the present state."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial

from moveit_msgs.msg import MotionPlanRequest, RobotState
from moveit_msgs.msg import PlanningScene as SceneMessage

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import PlanningError
from arm_planning.planner import Planner, planner_of
from arm_planning.planners.problem import never
from arm_planning.request import PlanRequest, PlanResponse
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.convert_constraints import ConstraintFrames, plan_request
from arm_planning.ros.convert_scene import state_change_of
from arm_planning.ros.planner_parameters import PlannerParameters
from arm_planning.ros.robot_setup import PlanningSetup
from arm_planning.ros.scene_monitor import SceneMonitor
from arm_planning.scene.frames import LinkPoses, frame_pose
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_changes import SceneOutcome, change_scene
from arm_planning.trajectory import TimedTrajectory

STATE_TIMEOUT_S = 1.0
LOGGER = logging.getLogger("move_group")


class PlanningSession:
    """What all services and actions that plan have in common; any thread may call it.

    Attributes:
        model: the robot.
        monitor: the present scene.
        parameters: what is set of the planners.
    """

    def __init__(self, setup: PlanningSetup, monitor: SceneMonitor) -> None:
        self.model: PlanningModel = setup.model
        self.monitor = monitor
        self.parameters = PlannerParameters()
        self._setup = setup
        self._idle: list[Planner] = []

    @contextmanager
    def planner(self) -> Iterator[Planner]:
        """Lend a planner that nobody else uses, so that watching a motion never waits for a plan.

        The one that came back last goes first: what it has compiled serves again.
        """
        try:
            planner = self._idle.pop()
        except IndexError:
            planner = Planner(
                self.model,
                self.monitor.scene,
                meshes=self._setup.meshes,
                tip_limits=self._setup.tip_limits,
                kinematics=self._setup.kinematics,
            )
        try:
            yield planner
        finally:
            self._idle.append(planner)

    def plan(
        self,
        request: MotionPlanRequest,
        diff: SceneMessage | None = None,
        *,
        from_present: bool = False,
        interrupted: Callable[[], bool] = never,
    ) -> PlanResponse:
        """Plan in the present scene with changes; it raises nothing for what is not possible.

        With `from_present` the start state is ignored, because the robot moves at once.
        """
        if from_present and is_given(request.start_state):
            LOGGER.warning(
                "Execution of motions should always start at the robot's current state. "
                "Ignoring the state supplied as start state in the motion planning request"
            )
        try:
            scene, remark = self.scene_for(diff, from_present=from_present, interrupted=interrupted)
            if not from_present and is_given(request.start_state):
                scene, remark = self.in_state(scene, request.start_state), ""
            with self.planner() as planner:
                response = planner.plan(self.request(request, scene), scene, interrupted)
        except PlanningError as error:
            return PlanResponse(error.code, str(error), {}, None, 0.0)
        if response.trajectory is not None and response.message:
            LOGGER.warning("%s", response.message)
        return replace(response, message="; ".join(filter(None, (response.message, remark))))

    def scene_for(
        self,
        diff: SceneMessage | None,
        *,
        from_present: bool,
        interrupted: Callable[[], bool],
    ) -> tuple[PlanningScene, str]:
        """Return the scene to plan in, the present one with changes, and a remark on it, or "".

        The changes are never a whole scene, whatever they say of themselves. With `from_present`
        the robot stays where it is, because it moves at once.

        Raises:
            PlanningError: a change is not possible.
        """
        remark = self.monitor.states.wait_for_fresh(STATE_TIMEOUT_S, interrupted)
        if remark:
            remark = f"planning starts from the last known state: {remark}"
            LOGGER.warning("%s", remark)
        scene = self.monitor.current()
        if diff is None:
            return scene, remark
        if from_present and is_given(diff.robot_state):
            LOGGER.warning(
                "Execution of motions should always start at the robot's current state. "
                "Ignoring the state supplied as difference in the planning scene diff"
            )
            diff.robot_state = RobotState(is_diff=True)
        # As upstream: clients send a default message, which would otherwise clear the scene.
        diff.is_diff = True
        return _all_of(self.monitor.applied(scene, diff)), remark

    def request(self, message: MotionPlanRequest, scene: PlanningScene) -> PlanRequest:
        """Return a request without its start state, its frames those of a scene.

        Raises:
            PlanningError: it names what does not exist.
        """
        request = plan_request(message, self._setup.seed, self.frames(scene), LOGGER.warning)
        parameters = self.parameters.of(planner_of(request), request.group)
        return replace(request, parameters=parameters)

    def watch(
        self, trajectory: TimedTrajectory, planned_in: PlanningScene
    ) -> Callable[[float], str]:
        """Return a function of the time since the start, which says what blocks the rest.

        It looks only when the scene has changed since it last looked. The scene is that from before
        the plan, so that changes while it was made count.
        """
        seen = planned_in

        def blocked(elapsed_s: float) -> str:
            nonlocal seen
            scene = self.monitor.scene
            if scene is seen:
                return ""
            seen = scene
            with self.planner() as planner:
                return planner.blocked_ahead(trajectory, elapsed_s, self.monitor.current())

        return blocked

    def frames(self, scene: PlanningScene) -> ConstraintFrames:
        """Return the frames that a request in this scene may name."""
        return ConstraintFrames(self.model, scene, partial(self._frame, scene))

    def state(self, message: RobotState) -> PlanningScene:
        """Return the present scene with the robot in a state; an empty one is the present state."""
        return self.in_state(self.monitor.current(), message)

    def in_state(self, scene: PlanningScene, state: RobotState) -> PlanningScene:
        """Return the scene with the robot in a state; an empty one changes nothing."""
        if not is_given(state):
            return scene
        change = state_change_of(self.model, state, LOGGER.warning)
        frames = [each.object.header.frame_id for each in state.attached_collision_objects]
        known = self.monitor.with_frames(scene, frames)
        return _all_of(change_scene(self.model, known, change, LOGGER.warning))

    def _frame(self, scene: PlanningScene, name: str) -> RigidTransform:
        known = self.monitor.with_frames(scene, [name])
        return frame_pose(known, LinkPoses(self.model, known.positions), name)


def _all_of(outcome: SceneOutcome) -> PlanningScene:
    """Return the changed scene of a request, which is refused if a part of it is not possible."""
    if outcome.problems:
        raise outcome.problems[0]
    return outcome.scene


def is_given(state: RobotState) -> bool:
    """Return whether a state says anything: MoveIt calls the others empty."""
    return bool(
        state.joint_state.name
        or state.multi_dof_joint_state.joint_names
        or state.attached_collision_objects
    )
