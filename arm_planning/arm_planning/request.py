"""A request to plan a motion, and the answer."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from arm_planning.constraints.constraints import MotionConstraints
from arm_planning.errors import MoveItErrorCode
from arm_planning.robot.model import JointPositions
from arm_planning.trajectory import TimedTrajectory


@dataclass(frozen=True, slots=True)
class PlanRequest:
    """What to plan, in the words of moveit_msgs/MotionPlanRequest.

    Attributes:
        group: name of the group to move.
        goals: alternatives; each is to be met as a whole.
        path: what holds on the whole way.
        start: positions of joints that differ from the scene's.
        pipeline: "ompl" or "pilz_industrial_motion_planner"; "" for the default.
        planner: its planner; "" for the group's default.
        attempts: number of plans to choose the shortest of.
        allowed_time_s: processor budget; the answer comes by then.
        velocity_scaling: fraction of the velocity limits to use, (0, 1].
        acceleration_scaling: likewise of the acceleration limits.
        seed: the same request, scene and seed give the same plan.
        parameters: of the planner, as `planner_parameters` names them.
    """

    group: str
    goals: tuple[MotionConstraints, ...]
    path: MotionConstraints = MotionConstraints()
    start: JointPositions | None = None
    pipeline: str = ""
    planner: str = ""
    attempts: int = 1
    allowed_time_s: float = 1.0
    velocity_scaling: float = 1.0
    acceleration_scaling: float = 1.0
    seed: int = 0
    parameters: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class PlanResponse:
    """The answer to a `PlanRequest`.

    Attributes:
        code: SUCCESS, or why there is no trajectory.
        message: one sentence: the reason and what to do; warnings of a success.
        start: positions of all active joints at the start.
        trajectory: None unless it succeeded.
        planning_time_s: wall time that it took.
    """

    code: MoveItErrorCode
    message: str
    start: JointPositions
    trajectory: TimedTrajectory | None
    planning_time_s: float
