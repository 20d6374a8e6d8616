"""The demonstrations of MoveIt's task constructor by the names that they have upstream."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import cos, pi, radians, sin

from arm_node.rigid_transform import RigidTransform
from arm_planning.demos.pick_place import CYLINDER, pick_place
from arm_planning.robot.model import PlanningModel
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.shapes import Box, Sphere
from arm_planning.tasks.containers import Alternatives, Fallbacks, SerialContainer
from arm_planning.tasks.costs import clearance, duration, link_motion, path_length
from arm_planning.tasks.motions import Connect, MoveRelative, MoveTo, Twist
from arm_planning.tasks.poses import ComputeIK, CurrentState, GeneratePose
from arm_planning.tasks.solvers import CartesianPathSolver, PipelinePlanner
from arm_planning.tasks.task import StagedTask


@dataclass(frozen=True, slots=True)
class TaskDemo:
    """A task to plan, and what it needs around it.

    Attributes:
        task: makes the task for a robot.
        max_solutions: number of solutions to look for.
        objects: what is put into the planning scene before.
    """

    task: Callable[[PlanningModel], StagedTask]
    max_solutions: int = 1
    objects: tuple[CollisionObject, ...] = ()


TIMES = 5
"""How often the modular task does the same."""
SPHERE = CollisionObject(
    "sphere", RigidTransform((-0.183, -0.14, 0.15)), (PlacedShape(Sphere(0.1)),)
)
BESIDE_SPHERE = RigidTransform((-0.183, 0.05, 0.15), (-sin(pi / 8), 0.0, 0.0, cos(pi / 8)))
BOX = CollisionObject(
    "box", RigidTransform((-0.06, -0.1, 0.4)), (PlacedShape(Box((0.02, 0.02, 0.02))),)
)
JOINTS = ("link1_to_link2", "link2_to_link3", "link3_to_link4", "link4_to_link5", "link5_to_link6")
TARGET = (0.5, -0.5, -1.0, 0.3, 0.0)
STARTS = {
    "near": (0.45, -0.5, -1.0, 0.3, 0.0),
    "bent the other way": (0.5, 0.5, 1.0, -0.3, 0.0),
    "behind the box": (-1.5, 0.5, 1.0, -0.3, 0.0),
}
"""A line leads to the target from the first only, and the box is in the way of the last."""


def alternative_path_costs(model: PlanningModel) -> StagedTask:
    """Return the task: the same way from home to `ready`, as each cost counts it."""
    costs = {
        "path length": path_length,
        "trajectory duration": duration,
        "link6_flange motion": link_motion("link6_flange"),
        "link3 motion": link_motion("link3"),
    }
    ways = [Connect(name, "arm", cost=cost) for name, cost in costs.items()]
    home, ready = (model.state("arm", name) for name in ("home", "ready"))
    return StagedTask(
        "alternative_path_costs",
        [CurrentState("home", home), Alternatives("connect", ways), CurrentState("ready", ready)],
    )


def cartesian(model: PlanningModel) -> StagedTask:
    """Return the task: from `ready` by two straight lines, a turn and a joint, then back."""
    return StagedTask(
        "cartesian",
        [
            CurrentState(),
            MoveTo("ready", "arm", "ready"),
            *_lines_and_a_turn(),
            MoveRelative("joint offset", "arm", {"link1_to_link2": radians(15)}),
            Connect("connect", "arm"),
            CurrentState("final state", model.state("arm", "ready")),
        ],
    )


def modular(_model: PlanningModel) -> StagedTask:
    """Return the task: one container five times, two straight lines and a turn; then home."""
    modules = [
        SerialContainer(
            f"module {number}", [*_lines_and_a_turn(), MoveTo("move to ready", "arm", "ready")]
        )
        for number in range(1, TIMES + 1)
    ]
    begin = [CurrentState(), MoveTo("ready", "arm", "ready")]
    return StagedTask("modular", [*begin, *modules, MoveTo("home", "arm", "home")])


def _lines_and_a_turn() -> list[MoveRelative]:
    return [
        MoveRelative("x +0.05", "arm", Twist("base_link", (0.05, 0.0, 0.0))),
        MoveRelative("y -0.02", "arm", Twist("base_link", (0.0, -0.02, 0.0))),
        MoveRelative("rz -18°", "arm", Twist("base_link", angular=(0.0, 0.0, -radians(18)))),
    ]


def fallbacks_move_to(_model: PlanningModel) -> StagedTask:
    """Return the task: from each of three states by the first planner that finds a way."""
    starts = [CurrentState(name, _positions(q)) for name, q in STARTS.items()]
    planners = {
        "Cartesian path": CartesianPathSolver(),
        "Pilz PTP": PipelinePlanner("pilz_industrial_motion_planner", "PTP"),
        "OMPL": PipelinePlanner(),
    }
    target = _positions(TARGET)
    ways = [MoveTo(name, "arm", target, planner) for name, planner in planners.items()]
    return StagedTask(
        "fallbacks_move_to",
        [Alternatives("initial states", starts), Fallbacks("move to target", ways)],
    )


def _positions(q: tuple[float, ...]) -> dict[str, float]:
    return dict(zip(JOINTS, q, strict=True))


def ik_clearance_cost(_model: PlanningModel) -> StagedTask:
    """Return the task: to all joint positions for a pose, the farthest from the sphere first."""
    pose = GeneratePose("target pose", BESIDE_SPHERE, monitors="current state")
    cost = clearance("arm", with_world=True, cumulative=False)
    return StagedTask(
        "ik_clearance_cost",
        [
            CurrentState(),
            Connect("connect", "arm"),
            ComputeIK("compute IK", pose, "arm", max_solutions=100, cost=cost),
        ],
    )


DEMOS: Mapping[str, TaskDemo] = {
    "alternative_path_costs": TaskDemo(alternative_path_costs, max_solutions=4),
    "cartesian": TaskDemo(cartesian),
    "fallbacks_move_to": TaskDemo(fallbacks_move_to, max_solutions=3, objects=(BOX,)),
    "ik_clearance_cost": TaskDemo(ik_clearance_cost, max_solutions=100, objects=(SPHERE,)),
    "modular": TaskDemo(modular),
    "pick_place_demo": TaskDemo(pick_place, objects=(CYLINDER,)),
}
