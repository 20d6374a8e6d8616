"""Plans motions without ROS: the face of this package."""

import logging
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from arm_description.resources import ResourceFinder
from arm_description.urdf.parser import parse_urdf
from arm_node.names import describe_known, listing
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.contact import CollisionContact
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.collision.model import CollisionModel
from arm_planning.collision.scene_difference import same_posture
from arm_planning.constraints.constraints import (
    MotionConstraints,
    joint_goal,
    pose_goal,
    snap_to_limits,
)
from arm_planning.constraints.evaluation import ConstraintEvaluator, ConstraintResult
from arm_planning.errors import (
    InvalidGoalError,
    InvalidPlanError,
    InvalidRequestError,
    MoveItErrorCode,
    PlanningError,
)
from arm_planning.kinematics.group_kinematics import GroupKinematics, KinematicsSettings
from arm_planning.pipeline import (
    SceneChecker,
    Timing,
    check_start,
    start_state,
    timed_and_proved,
)
from arm_planning.planners.cartesian import JumpLimits, cartesian_path
from arm_planning.planners.goals import GoalSampler
from arm_planning.planners.pilz.cartesian_limits import CartesianLimits
from arm_planning.planners.pilz.planner import PLANNERS, PilzPlanner
from arm_planning.planners.pilz.sequence import SequenceItem, plan_sequence
from arm_planning.planners.problem import Deadline, PlanningProblem, never
from arm_planning.planners.registry import planner_for, planner_ids
from arm_planning.request import PlanRequest, PlanResponse
from arm_planning.robot.build import planning_model
from arm_planning.robot.limits import JointLimitSettings
from arm_planning.robot.model import JointGroup, JointPositions, PlanningModel
from arm_planning.robot.srdf import parse_srdf
from arm_planning.scene.allowed_collisions import allowed_collisions
from arm_planning.scene.frames import LinkPoses
from arm_planning.scene.scene import PlanningScene
from arm_planning.srdf_maker import make_srdf
from arm_planning.timing.driven_spline import remaining
from arm_planning.trajectory import TimedTrajectory

Array = NDArray[np.float64]
OMPL, PILZ = "ompl", "pilz_industrial_motion_planner"
"""MoveIt's ids of the pipelines; the first is the default."""
STRAIGHT_CORNER = 1e-3
"""How far a straight motion of a link may pass by its way points in the joints, rad or m."""
NO_JUMP_LIMITS = JumpLimits()
FULL_SPEED = Timing()
MODELS_KEPT = 4
"""Compiled scenes that are kept for the next request."""
LOGGER = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class TimedCartesianPath:
    """A straight motion of a link.

    Attributes:
        trajectory: its motion; one point if the link cannot move at all.
        fraction: share of the way that it reaches, 0 to 1.
        stopped: why and where it stops; "" if it reaches the end.
    """

    trajectory: TimedTrajectory
    fraction: float
    stopped: str


class Planner:
    """Plans motions of one robot. For one thread at a time.

    Attributes:
        model: the robot with its groups.
        scene: the scene for the methods that are given none; replace it to change it.
    """

    def __init__(
        self,
        model: PlanningModel,
        scene: PlanningScene | None = None,
        *,
        resources: ResourceFinder | None = None,
        meshes: MeshPieces | None = None,
        tip_limits: CartesianLimits | None = None,
        kinematics: Mapping[str, KinematicsSettings] | None = None,
    ) -> None:
        """Make a planner.

        Args:
            model: the robot with its groups.
            scene: its surroundings; by default none, all joints at 0 or their nearest limit.
            resources: finds the robot's meshes.
            meshes: cuts meshes, instead of `resources`: planners that share it cut each once.
            tip_limits: speeds of a group's tip for Pilz' planners.
            kinematics: settings of groups for `inverse` and `cartesian_path`.
        """
        self.model = model
        self._tip_limits = tip_limits
        self._settings = dict(kinematics or {})
        self.scene = scene or PlanningScene(resting_positions(model))
        self._meshes = meshes or MeshPieces(resources)
        self._checkers: dict[str, tuple[PlanningScene, SceneChecker]] = {}
        self._inverse: dict[str, tuple[JointPositions, GroupKinematics]] = {}

    @classmethod
    def of_urdf(
        cls,
        urdf: str,
        srdf: str = "",
        *,
        limits: JointLimitSettings | None = None,
        resources: ResourceFinder | None = None,
    ) -> "Planner":
        """Return the planner of a robot.

        Args:
            urdf: text of the URDF.
            srdf: text of the SRDF; "" to make groups and allowed pairs from the URDF.
            limits: the content of joint_limits.yaml.
            resources: finds the robot's meshes.

        Raises:
            DescriptionError: the URDF cannot be used.
            SrdfError: the SRDF cannot be used.
        """
        robot = parse_urdf(urdf)
        meshes = MeshPieces(resources or ResourceFinder.of_description(urdf))
        semantic = (
            parse_srdf(srdf, robot) if srdf else make_srdf(robot, LOGGER.warning, meshes=meshes)
        )
        model = planning_model(robot, semantic, limits)
        scene = PlanningScene(resting_positions(model), allowed=allowed_collisions(semantic))
        return cls(model, scene, meshes=meshes)

    def plan(
        self,
        request: PlanRequest,
        scene: PlanningScene | None = None,
        interrupted: Callable[[], bool] = never,
    ) -> PlanResponse:
        """Return the answer to a request; it raises nothing for a request that cannot be met.

        Args:
            request: what to plan.
            scene: the scene; by default the planner's.
            interrupted: tells when planning is to end early, with PREEMPTED.
        """
        started_s = time.monotonic()
        remarks: list[str] = []
        scene = scene or self.scene
        if request.start:
            scene = replace(scene, positions={**scene.positions, **request.start})
        start: JointPositions = scene.positions
        trajectory, code = None, MoveItErrorCode.SUCCESS
        try:
            group = self._group(request.group)
            begin = start_state(group, scene)
            start = begin.positions
            if begin.remark:
                remarks.append(begin.remark)
            scene = replace(scene, positions=start)
            trajectory = self._solve(request, group, scene, remarks.append, interrupted)
        except PlanningError as error:
            code, remarks = error.code, [str(error)]
        return PlanResponse(
            code, "; ".join(remarks), start, trajectory, time.monotonic() - started_s
        )

    def move(
        self,
        group: str,
        goal: JointPositions | str | RigidTransform,
        *,
        link: str = "",
        allowed_time_s: float = 5.0,
        timing: Timing = FULL_SPEED,
        seed: int = 0,
        scene: PlanningScene | None = None,
    ) -> TimedTrajectory:
        """Return a motion from the scene's state to a goal.

        Args:
            group: the group that moves.
            goal: positions of joints, rad or m, where others stay; the name of a state of the
                group; or the pose of the link in the planning frame.
            link: the link of a pose; "" for the group's tip.
            allowed_time_s: when planning gives up.
            timing: speed; by default as fast as the limits allow.
            seed: the same goal, scene and seed give the same motion.
            scene: the scene; by default the planner's.

        Raises:
            PlanningError: there is no plan; the message says why.
        """
        request = PlanRequest(
            group,
            (self._goal(self._group(group), goal, link, scene or self.scene),),
            allowed_time_s=allowed_time_s,
            velocity_scaling=timing.velocity_scaling,
            acceleration_scaling=timing.acceleration_scaling,
            seed=seed,
        )
        response = self.plan(request, scene)
        if response.trajectory is None:
            raise PlanningError(response.code, response.message)
        return response.trajectory

    def contacts(
        self, group: str = "", scene: PlanningScene | None = None
    ) -> tuple[CollisionContact, ...]:
        """Return what touches in the scene's state, the deepest contact of each pair.

        Args:
            group: the group that is checked; "" for the whole robot.
            scene: the scene; by default the planner's.

        Raises:
            PlanningError: there is no such group.
        """
        scene = scene or self.scene
        checker = self.checker(scene, group)
        return checker.contacts(np.array([scene.positions[j] for j in checker.model.joints]))

    def link_pose(self, link: str, scene: PlanningScene | None = None) -> RigidTransform:
        """Return a link's pose in the planning frame.

        Raises:
            PlanningError: INVALID_LINK_NAME: there is no such link.
        """
        return LinkPoses(self.model, (scene or self.scene).positions).of(link)

    def inverse(
        self,
        group: str,
        target: RigidTransform,
        *,
        link: tuple[str, RigidTransform] | None = None,
        timeout_s: float = 0.0,
        avoids_collisions: bool = False,
        constraints: MotionConstraints | None = None,
        scene: PlanningScene | None = None,
    ) -> dict[str, float]:
        """Return the positions of all active joints with a link at a pose.

        The search starts from the scene's state; see `InverseKinematics.solve`.

        Args:
            group: the group that moves.
            target: the pose in the planning frame.
            link: the link, and the pose of what is placed in the link's frame; by default the
                group's tip itself.
            timeout_s: length of the search; 0 for the default.
            avoids_collisions: whether only states that are free count.
            constraints: what must hold as well.
            scene: the scene; by default the planner's.

        Raises:
            PlanningError: NO_IK_SOLUTION, and what is wrong with the arguments.
        """
        scene = scene or self.scene
        name, offset = link or ("", RigidTransform())
        kinematics = self._kinematics(group, scene)
        solver, settings = kinematics.of(name), kinematics.settings
        q = solver.group.positions(scene.positions)
        checks: list[Callable[[Array], bool]] = []
        if avoids_collisions:
            checks.append(self.checker(scene, group).is_free)
        if constraints:
            checks.append(self._evaluator(constraints, solver.group, scene).satisfied)
        found = solver.solve(
            target.then(offset.inverse()),
            q,
            timeout_s=timeout_s or settings.timeout_s,
            orientation=settings.orientation,
            free=(lambda q: all(check(q) for check in checks)) if checks else None,
        )
        return {**scene.positions, **dict(zip(solver.group.joints, found.tolist(), strict=True))}

    def cartesian_path(
        self,
        group: str,
        way_points: Sequence[RigidTransform],
        *,
        max_step_m: float = 0.01,
        link: str = "",
        relative: bool = False,
        jumps: JumpLimits = NO_JUMP_LIMITS,
        avoids_collisions: bool = True,
        path: MotionConstraints = MotionConstraints(),
        timing: Timing = FULL_SPEED,
        scene: PlanningScene | None = None,
    ) -> TimedCartesianPath:
        """Return the motion that moves a link straight through way points, as far as it goes.

        Args:
            group: the group that moves, from the scene's state.
            way_points: poses of the link in the planning frame.
            max_step_m: distance between two points at most.
            link: the link; "" for the group's tip.
            relative: whether each way point is in the link's frame at the one before it.
            jumps: limits of what joints move between two points.
            avoids_collisions: whether the path ends before a collision.
            path: what holds on the way.
            timing: speed.
            scene: the scene; by default the planner's.

        Raises:
            PlanningError: an argument is wrong.
        """
        scene = scene or self.scene
        own = self._group(group)
        scene = replace(scene, positions=start_state(own, scene).positions)
        evaluator = self._evaluator(path, own, scene)
        checker = self.checker(scene, group)
        kinematics = self._kinematics(group, scene)
        found = cartesian_path(
            kinematics.of(link),
            own.positions(scene.positions),
            way_points,
            max_step_m,
            relative=relative,
            orientation=kinematics.settings.orientation,
            jumps=jumps,
            checker=checker if avoids_collisions else None,
            violation=evaluator.violation if path else None,
        )
        judge = checker if avoids_collisions else None
        if len(found.points) < 2:
            # There is no motion to prove; `stopped` says what is wrong with the start.
            judge, evaluator = None, self._evaluator(MotionConstraints(), own, scene)
        trajectory = timed_and_proved(
            found.points, own, judge, evaluator, timing, corner=STRAIGHT_CORNER
        )
        return TimedCartesianPath(trajectory, found.fraction, found.stopped)

    def sequence(
        self,
        items: Sequence[SequenceItem],
        scene: PlanningScene | None = None,
        interrupted: Callable[[], bool] = never,
    ) -> tuple[TimedTrajectory, ...]:
        """Return the motions of Pilz' planners one after the other, blended where asked for.

        Args:
            items: the motions.
            scene: the scene; by default the planner's.
            interrupted: tells when planning is to end early, with PREEMPTED.

        Raises:
            PlanningError: a motion cannot be planned, or is not free; the message says which.
        """
        scene = scene or self.scene
        groups = {self._group(item.request.group).name for item in items}
        free = self.checker(scene, groups.pop()).is_free if len(groups) == 1 else None
        own = [
            replace(
                item,
                request=replace(item.request, planner=planner_of(item.request)),
            )
            for item in items
        ]
        found = plan_sequence(
            PilzPlanner(self.model, self._tip_limits),
            own,
            scene.positions,
            free,
            Deadline(interrupted=interrupted),
        )
        positions = dict(scene.positions)
        for trajectory in found:
            group = self._group_of(trajectory)
            checker = self.checker(replace(scene, positions=dict(positions)), group)
            obstruction = checker.prove_driven(trajectory)
            if obstruction is not None:
                raise InvalidPlanError(
                    f"the motion is not free: {obstruction}; Pilz' planners go around nothing, "
                    "the pipeline 'ompl' does"
                )
            positions.update(zip(trajectory.joints, trajectory.positions[-1].tolist(), strict=True))
        return found

    def evaluate(
        self, constraints: MotionConstraints, scene: PlanningScene | None = None
    ) -> tuple[ConstraintResult, ...]:
        """Return what each constraint says about the scene's state."""
        scene = scene or self.scene
        every = JointGroup("", self.model.joints, (), (), ())
        links = LinkPoses(self.model, scene.positions)
        evaluator = ConstraintEvaluator(
            constraints,
            self.model,
            every,
            scene.positions,
            lambda _, link: np.array(links.of(link).matrix()),
        )
        return evaluator.results(every.positions(scene.positions))

    def blocked_ahead(
        self, trajectory: TimedTrajectory, elapsed_s: float, scene: PlanningScene | None = None
    ) -> str:
        """Return what blocks the rest of a motion that runs since so many seconds, or ""."""
        scene = scene or self.scene
        group = self._group_of(trajectory)
        obstruction = self.checker(scene, group).prove_driven(remaining(trajectory, elapsed_s))
        return "" if obstruction is None else str(obstruction)

    def checker(self, scene: PlanningScene, group: str = "") -> SceneChecker:
        """Return the collision checks of a group in a scene; the latest ones are kept."""
        kept = self._checkers.get(group)
        if kept is not None and _is_same(kept[0], scene, self._joints(group)):
            return kept[1]
        like = None if kept is None else kept[1].model
        model = CollisionModel(self.model, scene, group or None, self._meshes, like)
        checker = SceneChecker(model)
        if len(self._checkers) >= MODELS_KEPT:
            self._checkers.clear()
        self._checkers[group] = scene, checker
        return checker

    def _goal(
        self,
        group: JointGroup,
        goal: JointPositions | str | RigidTransform,
        link: str,
        scene: PlanningScene,
    ) -> MotionConstraints:
        if isinstance(goal, RigidTransform):
            return pose_goal(link or group.tip, goal)
        if isinstance(goal, str):
            goal = self.model.state(group.name, goal)
        elif other := [joint for joint in goal if joint not in group.joints]:
            raise InvalidGoalError(
                f"group '{group.name}' has no joint '{other[0]}'; it has {listing(group.joints)}"
            )
        others = {joint: scene.positions[joint] for joint in group.joints if joint not in goal}
        return joint_goal({**goal, **others})

    def _group_of(self, trajectory: TimedTrajectory) -> str:
        """Return the group with the joints of a trajectory; "" for the whole robot.

        Raises:
            PlanningError: INVALID_GROUP_NAME: no group has these joints.
        """
        for name, group in self.model.groups.items():
            if group.joints == trajectory.joints:
                return name
        joints = listing(trajectory.joints)
        raise PlanningError(MoveItErrorCode.INVALID_GROUP_NAME, f"no group has the joints {joints}")

    def _joints(self, group: str) -> Sequence[str]:
        return self._group(group).joints if group else self.model.joints

    def _group(self, name: str) -> JointGroup:
        if not name:
            raise PlanningError(
                MoveItErrorCode.INVALID_GROUP_NAME,
                f"No group specified to plan for; the robot has {listing(self.model.groups)}",
            )
        return self.model.group(name)

    def _solve(
        self,
        request: PlanRequest,
        group: JointGroup,
        scene: PlanningScene,
        remark: Callable[[str], None],
        interrupted: Callable[[], bool],
    ) -> TimedTrajectory:
        if request.pipeline == PILZ:
            return self.sequence([SequenceItem(request)], scene, interrupted)[0]
        if request.pipeline not in ("", OMPL):
            known = describe_known(request.pipeline, pipelines(), "there are")
            raise InvalidRequestError(f"no pipeline '{request.pipeline}'; {known}")
        checker = self.checker(scene, group.name)
        path = self._evaluator(request.path, group, scene)
        start = group.positions(scene.positions)
        deadline = Deadline.after(request.allowed_time_s, interrupted)
        goals = GoalSampler(
            tuple(snap_to_limits(goal, group, remark) for goal in request.goals),
            request.path,
            self.model,
            group,
            scene.positions,
            checker.model.link_pose,
            self._kinematics(group.name, scene),
            checker,
            start,
            request.seed,
            deadline,
        )
        problem = PlanningProblem(
            group,
            start,
            goals,
            checker,
            path if request.path else None,
            deadline,
            request.seed,
            request.attempts,
        )
        try:
            found = planner_for(planner_of(request), request.parameters).plan(problem)
        except PlanningError as error:
            if error.code is MoveItErrorCode.START_STATE_IN_COLLISION:
                check_start(checker, start)
            raise
        timing = Timing(request.velocity_scaling, request.acceleration_scaling)
        return timed_and_proved(found, group, checker, path, timing, deadline=deadline)

    def _evaluator(
        self, constraints: MotionConstraints, group: JointGroup, scene: PlanningScene
    ) -> ConstraintEvaluator:
        pose = self.checker(scene, group.name).model.link_pose
        return ConstraintEvaluator(constraints, self.model, group, scene.positions, pose)

    def _kinematics(self, group: str, scene: PlanningScene) -> GroupKinematics:
        own = self._group(group).joints
        outside = {joint: q for joint, q in scene.positions.items() if joint not in own}
        kept = self._inverse.get(group)
        is_same = kept is not None and same_posture(kept[0], outside, ())
        if kept is None or not is_same:
            settings = self._settings.get(group, KinematicsSettings())
            kept = outside, GroupKinematics(self.model, group, outside, settings)
            self._inverse[group] = kept
        return kept[1]


def pipelines() -> dict[str, tuple[str, tuple[str, ...]]]:
    """Return MoveIt's title and the planners of each pipeline, by its id."""
    return {
        OMPL: ("OMPL", planner_ids()),
        PILZ: ("Pilz Industrial Motion Planner", PLANNERS),
    }


def resting_positions(model: PlanningModel) -> dict[str, float]:
    """Return 0 for each active joint, or the nearest position within its limits."""
    return {
        joint.name: min(max(0.0, joint.limit.lower), joint.limit.upper) if joint.limit else 0.0
        for joint in map(model.robot.joint, model.joints)
    }


def planner_of(request: PlanRequest) -> str:
    """Return a planner's id without the group that RViz and MoveIt's clients put around it."""
    given, group = request.planner, request.group
    inner = given.removeprefix(f"{group}[").removesuffix("]")
    return "" if given == group else inner if given.startswith(f"{group}[") else given


def _is_same(before: PlanningScene, scene: PlanningScene, varying: Sequence[str]) -> bool:
    """Return whether a compiled scene serves for another: only varying joints may differ."""
    if before is scene:
        return True
    same = replace(before, positions=scene.positions) == scene
    return same and same_posture(before.positions, scene.positions, varying)
