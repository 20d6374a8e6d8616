"""`arm move`: plan a motion of the running robot, and execute it."""

import argparse
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from arm_cli.arguments import JSON, Argument, Exclusive, Flag, finite_number, positive_number, verb
from arm_cli.errors import CommandUsageError, NoSuchNameError
from arm_cli.output import complain, say_answer
from arm_cli.ros.connection import connect
from arm_node.environment import PLANNING_PACKAGES

if TYPE_CHECKING:
    from arm_cli.ros.move_group import MoveGroupClient
    from arm_planning.robot.model import JointGroup, PlanningModel

FULL_TURN_RAD = math.tau
SHORTEST_S = 0.005
"""A shorter motion only takes off what a servo is away from its goal."""
EXTRA_TIME_S = 5.0
"""How much longer than its planning time a plan may take to arrive."""


def _joint_position(word: str) -> tuple[str, float]:
    """Split JOINT=POSITION into a name and a number, for argparse."""
    joint, _, text = word.partition("=")
    try:
        return joint, finite_number(text)
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(f"{word}: write it as {joint or 'j1'}=0.5") from None


@verb(
    Exclusive(
        Argument(
            "--pose",
            nargs="+",
            type=finite_number,
            metavar="NUMBER",
            help="X Y Z of the link in m, and ROLL PITCH YAW in rad for its orientation as well",
        ),
        Argument("--state", metavar="NAME", help="a named state of the group, such as home"),
        Argument(
            "--joints",
            nargs="+",
            type=_joint_position,
            metavar="JOINT=POSITION",
            help="positions in rad or m; joints that are not named stay",
        ),
    ),
    Argument("--group", default="", help="the group to move (default: the first chain)"),
    Argument("--link", default="", help="the link that the pose is for (default: the group's tip)"),
    Argument("--frame", default="", help="the frame of the pose (default: the planning frame)"),
    Argument("--planner", default="", help="planner_id; `--pipeline` names its pipeline"),
    Argument("--pipeline", default="", help="pipeline_id, such as pilz_industrial_motion_planner"),
    Argument("--speed", type=positive_number, default=1.0, help="fraction of the velocity limits"),
    Argument(
        "--acceleration",
        type=positive_number,
        default=1.0,
        help="fraction of the acceleration limits",
    ),
    Argument(
        "--time", type=positive_number, default=5.0, metavar="SECONDS", help="time to plan in"
    ),
    Flag("--plan-only", help="plan, and do not move"),
    Argument("-n", "--namespace", default="/", metavar="NS", help="namespace of move_group"),
    JSON,
)
def move(options: argparse.Namespace) -> None:
    """Plan and move; print what was planned."""
    if options.pose is None and options.state is None and options.joints is None:
        raise CommandUsageError(
            "say where to: --pose X Y Z, --state NAME or --joints JOINT=POSITION"
        )
    if options.pose is not None and len(options.pose) not in (3, 6):
        raise CommandUsageError(
            f"--pose takes X Y Z or X Y Z ROLL PITCH YAW, not {len(options.pose)} numbers"
        )
    for angle in (options.pose or ())[3:]:
        if abs(angle) > FULL_TURN_RAD:
            raise CommandUsageError(
                f"--pose takes angles in rad, and {angle:g} is {angle / FULL_TURN_RAD:.1f} turns; "
                f"{angle:g} degrees are {math.radians(angle):.4g}"
            )
    for option in ("speed", "acceleration"):
        if getattr(options, option) > 1.0:
            raise CommandUsageError(
                f"--{option} is a fraction of the limits, up to 1, not {getattr(options, option):g}"
            )
    with connect(packages=PLANNING_PACKAGES) as session:
        from arm_cli.ros.move_group import MoveGroupClient

        client = MoveGroupClient(session, options.namespace)
        model = client.model()
        group = _group(model, options.group)
        timeout_s = options.time + EXTRA_TIME_S if options.plan_only else None
        goal = _goal(model, group, options, client)
        result = client.move(_request(group, goal, options), timeout_s)
    if result.error_code.message:
        complain(f"arm move: {result.error_code.message}")
    say_answer(options, _document(result), [_summary(result, group)])


def _group(model: "PlanningModel", name: str) -> "JointGroup":
    from arm_planning.errors import PlanningError

    try:
        return model.group(name) if name else model.default_group()
    except PlanningError as error:
        raise NoSuchNameError(str(error)) from error


def _goal(
    model: "PlanningModel",
    group: "JointGroup",
    options: argparse.Namespace,
    client: "MoveGroupClient",
) -> Any:
    from arm_description.transforms import quaternion_from_rpy
    from arm_planning.ros.goal_messages import joint_goal, pose_goal

    if options.state is not None:
        return joint_goal(_state(model, group.name, options.state))
    if options.joints is not None:
        given = _known_joints(model, group, dict(options.joints))
        others = [joint for joint in group.joints if joint not in given]
        return joint_goal({**given, **client.positions(others)})
    x, y, z, *rpy = options.pose
    link = options.link or group.tip
    if not link:
        raise CommandUsageError(f"group '{group.name}' has no tip: name the link with --link")
    turned = tuple(quaternion_from_rpy(rpy).tolist()) if rpy else None
    return pose_goal(link, (x, y, z), turned, options.frame)


def _state(model: "PlanningModel", group: str, name: str) -> Mapping[str, float]:
    from arm_planning.errors import PlanningError

    try:
        return model.state(group, name)
    except PlanningError as error:
        raise NoSuchNameError(str(error)) from error


def _known_joints(
    model: "PlanningModel", group: "JointGroup", positions: Mapping[str, float]
) -> Mapping[str, float]:
    for joint in positions:
        if joint not in group.joints:
            others = [name for name, other in model.groups.items() if joint in other.joints]
            advice = (
                f"--group {others[0]} has it" if others else f"it has {', '.join(group.joints)}"
            )
            raise NoSuchNameError(f"group '{group.name}' has no joint '{joint}'; {advice}")
    return positions


def _request(group: "JointGroup", goal_constraints: Any, options: argparse.Namespace) -> Any:
    """Return the action's goal."""
    from arm_planning.ros.goal_messages import move_goal, plan_message

    asked = plan_message(
        group.name,
        goal_constraints,
        planner_id=options.planner,
        pipeline_id=options.pipeline,
        num_planning_attempts=1,
        allowed_planning_time=options.time,
        max_velocity_scaling_factor=options.speed,
        max_acceleration_scaling_factor=options.acceleration,
    )
    return move_goal(asked, plan_only=options.plan_only)


def _summary(result: Any, group: "JointGroup") -> str:
    points = result.planned_trajectory.joint_trajectory.points
    ends_s = [each.time_from_start.sec + each.time_from_start.nanosec * 1e-9 for each in points]
    duration_s = max(ends_s, default=0.0)
    if duration_s < SHORTEST_S:
        return "the robot is there already"
    verb = "moved" if result.executed_trajectory.joint_trajectory.points else "planned for"
    return (
        f"{verb} group '{group.name}': {len(points)} points in {duration_s:.2f} s, planned in "
        f"{result.planning_time * 1e3:.0f} ms"
    )


def _document(result: Any) -> dict[str, Any]:
    trajectory = result.planned_trajectory.joint_trajectory
    return {
        "joints": list(trajectory.joint_names),
        "planning_time_s": result.planning_time,
        "points": [
            {
                "time_s": point.time_from_start.sec + point.time_from_start.nanosec * 1e-9,
                "positions": list(point.positions),
                "velocities": list(point.velocities),
            }
            for point in trajectory.points
        ],
    }
