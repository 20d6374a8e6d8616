"""How stages plan their motions."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from arm_node.rigid_transform import RigidTransform
from arm_planning.constraints.constraints import JointConstraint, MotionConstraints, pose_goal
from arm_planning.errors import NoPlanError, PlanningError
from arm_planning.pipeline import Timing
from arm_planning.planner import FULL_SPEED, Planner
from arm_planning.request import PlanRequest
from arm_planning.scene.scene import PlanningScene
from arm_planning.tasks.stage import TaskSearch
from arm_planning.trajectory import TimedTrajectory

Goal = Mapping[str, float] | RigidTransform
"""Positions of all joints of a group, or the pose of its tip in the planning frame."""
SAME_POSITION = 1e-3
"""Difference of joint positions, rad or m, that does not matter to a stage."""
EXACT = 1e-9
"""Tolerance of joint goals, rad or m: the next stage begins exactly there."""


class Solver(Protocol):
    """Plans the motion of a stage."""

    def plan(
        self, search: TaskSearch, group: str, scene: PlanningScene, goal: Goal
    ) -> TimedTrajectory:
        """Return the motion of a group from a scene to a goal.

        Raises:
            PlanningError: there is none.
        """
        ...


@dataclass(frozen=True, slots=True)
class PipelinePlanner:
    """A planner of `Planner.plan`.

    Attributes:
        pipeline: its pipeline; "" for OMPL.
        planner: its id; "" for the default.
        timeout_s: how long it may plan.
        timing: speed.
    """

    pipeline: str = ""
    planner: str = ""
    timeout_s: float = 10.0
    timing: Timing = FULL_SPEED

    def plan(
        self, search: TaskSearch, group: str, scene: PlanningScene, goal: Goal
    ) -> TimedTrajectory:
        """Return the motion; see `Solver`."""
        request = PlanRequest(
            group,
            (_constraints(search.planner, group, goal),),
            pipeline=self.pipeline,
            planner=self.planner,
            allowed_time_s=self.timeout_s,
            velocity_scaling=self.timing.velocity_scaling,
            acceleration_scaling=self.timing.acceleration_scaling,
            seed=search.seed,
        )
        response = search.planner.plan(request, scene, search.deadline.interrupted)
        if response.trajectory is None:
            raise PlanningError(response.code, response.message)
        return response.trajectory


@dataclass(frozen=True, slots=True)
class CartesianPathSolver:
    """The group's tip moves straight.

    Attributes:
        step_m: distance between two points at most.
        timing: speed.
    """

    step_m: float = 0.005
    timing: Timing = FULL_SPEED

    def plan(
        self, search: TaskSearch, group: str, scene: PlanningScene, goal: Goal
    ) -> TimedTrajectory:
        """Return the motion; see `Solver`."""
        planner, tip = search.planner, search.planner.model.group(group).tip
        if not isinstance(goal, RigidTransform):
            there = PlanningScene({**scene.positions, **goal})
            goal, wanted = planner.link_pose(tip, there), goal
        else:
            wanted = {}
        found = planner.cartesian_path(
            group, [goal], max_step_m=self.step_m, timing=self.timing, scene=scene
        )
        if found.stopped:
            raise NoPlanError(found.stopped)
        ends = zip(found.trajectory.joints, found.trajectory.positions[-1].tolist(), strict=True)
        off = {joint: q for joint, q in ends if abs(wanted.get(joint, q) - q) > SAME_POSITION}
        if off:
            joint, q = next(iter(off.items()))
            raise NoPlanError(
                f"the straight path ends in another posture: joint '{joint}' at {q:.3f} instead "
                f"of {wanted[joint]:.3f}"
            )
        return found.trajectory


def _constraints(planner: Planner, group: str, goal: Goal) -> MotionConstraints:
    if isinstance(goal, RigidTransform):
        return pose_goal(planner.model.group(group).tip, goal)
    joints = (JointConstraint(joint, q, EXACT, EXACT) for joint, q in goal.items())
    return MotionConstraints(tuple(joints))
