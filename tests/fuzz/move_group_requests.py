"""Requests to `move_group` that nobody would send, and what must be true of each answer.

An input is a JSON of messages: useful ones of which some values were replaced.
"""

import json
import math
import random
from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
from moveit_msgs.msg import MotionPlanRequest, MotionSequenceRequest, RobotTrajectory
from moveit_msgs.msg import PlanningScene as SceneMessage

from arm_node.messages import MessageValueError
from arm_node.messages.filling import fill_message
from arm_planning import Planner
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.planners.pilz.cartesian_limits import CartesianLimits
from arm_planning.request import PlanRequest
from arm_planning.ros.answering import BusyLimit, QuickServices
from arm_planning.ros.convert_scene import scene_change_of
from arm_planning.ros.plan_display import PlanDisplay
from arm_planning.ros.planning_services import PlanningServices, StateServices
from arm_planning.ros.planning_session import PlanningSession
from arm_planning.ros.robot_setup import PlanningSetup
from arm_planning.ros.sequence_server import SequenceSession
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_changes import SceneOutcome, change_scene

JOINTS = ("j0", "j1", "j2", "j3", "j4")
LONGEST_S = 0.03
"""For a plan."""
SUCCESS = 1
FAULT = "has a fault"

NUMBERS = (math.nan, math.inf, -math.inf, 0.0, -1.0, 1e308, 1e-308, 1e-12, 1e9, -0.3, 2.5)
NAMES = (
    *("", "/", "arm", "gone", "l5", "l0", "j0", "j9", "box", "box/top", "held", "world", "ready"),
    *("arm[RRTConnect]", "RRTConnect", "PRM", "PTP", "LIN", "CIRC", "center", "interim", "ompl"),
    *("pilz_industrial_motion_planner", "a" * 2000, "\u00fc\n\u2028"),
)
MOST_REPLACED = 5

LINK = (
    "<link name='l{0}'><collision><origin xyz='0 0 .07'/><geometry><capsule radius='.03' "
    "length='.08'/></geometry></collision></link>"
)
JOINT = (
    "<joint name='j{0}' type='{1}'><parent link='l{0}'/><child link='l{2}'/><origin xyz='0 0 .2'/>"
    "<axis xyz='{3}'/><limit lower='{4}' upper='{5}' effort='1' velocity='2'/></joint>"
)
URDF = (
    "<robot name='r'>"
    + "".join(LINK.format(n) for n in range(6))
    + JOINT.format(0, "revolute", 1, "0 0 1", -2, 2)
    + JOINT.format(1, "revolute", 2, "0 1 0", -2, 2)
    + JOINT.format(2, "continuous", 3, "0 1 0", 0, 0)
    + JOINT.format(3, "prismatic", 4, "0 0 1", 0, 0.2)
    + JOINT.format(4, "revolute", 5, "0 1 0", -2, 2)
    + "</robot>"
)
SRDF = """<robot name='r'><group name='arm'><chain base_link='l0' tip_link='l5'/></group>
<group_state name='ready' group='arm'><joint name='j1' value='0.5'/></group_state>
<disable_collisions link1='l0' link2='l1' reason='Adjacent'/>
<disable_collisions link1='l1' link2='l2' reason='Adjacent'/>
<disable_collisions link1='l2' link2='l3' reason='Adjacent'/>
<disable_collisions link1='l3' link2='l4' reason='Adjacent'/>
<disable_collisions link1='l4' link2='l5' reason='Adjacent'/></robot>"""


def make(chance: random.Random) -> tuple[str, bytes]:
    """Return a request of a kind: what it is called, and its JSON."""
    kind = chance.choice(list(_KINDS))
    message = _KINDS[kind](chance)
    for _ in range(chance.choice((0, 1, 1, 2, MOST_REPLACED))):
        _replace_one(message, chance)
    return kind, json.dumps(message).encode()


def _replace_one(message: Any, chance: random.Random) -> None:
    """Replace a value anywhere in a message, or a whole list or message of it."""
    while True:
        keys = list(message) if isinstance(message, dict) else list(range(len(message)))
        if not keys:
            return
        key = chance.choice(keys)
        inner = message[key]
        if isinstance(inner, dict | list) and inner and chance.random() < 0.9:
            message = inner
            continue
        message[key] = _other(inner, chance)
        return


def _other(value: Any, chance: random.Random) -> Any:
    match value:
        case bool():
            return not value
        case int():
            return chance.randrange(9)
        case float():
            return chance.choice(NUMBERS)
        case str():
            return chance.choice(NAMES)
        case list():
            return chance.choice(([], 2 * value, value[:1], 40 * value[:1]))
        case _:
            return {}


def _pose(chance: random.Random) -> dict[str, Any]:
    # The arm's plane turns about the vertical, and the tip in it.
    around, pitch = chance.uniform(-1.8, 1.8), chance.uniform(0.5, 2.0)
    x, y = 0.3 * math.cos(around), 0.3 * math.sin(around)
    a, b = around / 2.0, pitch / 2.0
    return {
        "position": {"x": x, "y": y, "z": chance.uniform(0.3, 0.7)},
        "orientation": {
            "x": -math.sin(a) * math.sin(b),
            "y": math.cos(a) * math.sin(b),
            "z": math.sin(a) * math.cos(b),
            "w": math.cos(a) * math.cos(b),
        },
    }


def _positions(chance: random.Random) -> list[float]:
    slide = chance.uniform(0.0, 0.2)
    return [*(chance.uniform(-1.2, 1.2) for _ in range(3)), slide, chance.uniform(-1.2, 1.2)]


def _state(chance: random.Random) -> dict[str, Any]:
    if chance.random() < 0.5:
        return {"is_diff": True}
    joints = {"name": list(JOINTS), "position": _positions(chance)}
    held = {"link_name": "l5", "object": _box(chance, "held"), "touch_links": ["l5", "l3"]}
    held["object"]["header"]["frame_id"] = "l5"
    held["object"]["pose"]["position"] = {"x": 0.0, "y": 0.0, "z": 0.2}
    attached = [held] if chance.random() < 0.3 else []
    return {"joint_state": joints, "is_diff": True, "attached_collision_objects": attached}


def _box(chance: random.Random, name: str) -> dict[str, Any]:
    kind, sizes = chance.choice(((1, 3), (2, 1), (3, 2), (4, 2)))
    solid = {"type": kind, "dimensions": [0.1] * sizes}
    corners = [{"x": x, "y": y, "z": z} for x, y, z in np.eye(4, 3).tolist()]
    faces = [{"vertex_indices": [a, b, c]} for a, b, c in ((0, 1, 2), (0, 1, 3), (1, 2, 3))]
    mesh = chance.random() < 0.2
    return {
        "header": {"frame_id": chance.choice(("l0", "", "l5"))},
        "id": name,
        "pose": _pose(chance),
        "primitives": [solid],
        "primitive_poses": [{}],
        "meshes": [{"vertices": corners, "triangles": faces}] if mesh else [],
        "mesh_poses": [{}] if mesh else [],
        "planes": [],
        "subframe_names": ["top"],
        "subframe_poses": [_pose(chance)],
    }


def _scene(chance: random.Random) -> dict[str, Any]:
    boxes = [_box(chance, f"box{n}" if n else "box") for n in range(chance.randrange(4))]
    return {
        "is_diff": True,
        "name": "s",
        "robot_state": _state(chance),
        "world": {"collision_objects": boxes},
        "allowed_collision_matrix": {
            "entry_names": [],
            "default_entry_names": ["box"],
            "default_entry_values": [False],
        },
        "link_padding": [{"link_name": "l5", "padding": 0.01}],
        "link_scale": [{"link_name": "l3", "scale": 1.1}],
        "fixed_frame_transforms": [],
    }


def _orientation(chance: random.Random) -> dict[str, Any]:
    return {
        "header": {"frame_id": chance.choice(("l0", ""))},
        "link_name": "l5",
        "orientation": _pose(chance)["orientation"],
        "absolute_x_axis_tolerance": 0.5,
        "absolute_y_axis_tolerance": 0.5,
        "absolute_z_axis_tolerance": 3.1,
        "parameterization": chance.choice((0, 1)),
        "weight": 1.0,
    }


def _goal(chance: random.Random) -> dict[str, Any]:
    if chance.random() < 0.6:
        tolerance = {"tolerance_above": 0.01, "tolerance_below": 0.01, "weight": 1.0}
        pairs = zip(JOINTS, _positions(chance), strict=True)
        return {
            "joint_constraints": [{"joint_name": j, "position": p, **tolerance} for j, p in pairs]
        }
    ball = {"type": 2, "dimensions": [0.02]}
    region = {"primitives": [ball], "primitive_poses": [_pose(chance)]}
    position = {
        "header": {"frame_id": "l0"},
        "link_name": "l5",
        "target_point_offset": {"x": 0.0, "y": 0.0, "z": 0.1},
        "constraint_region": region,
        "weight": 1.0,
    }
    return {"position_constraints": [position], "orientation_constraints": [_orientation(chance)]}


def _request(chance: random.Random, pipeline: str = "") -> dict[str, Any]:
    pilz = pipeline or chance.choice(("", "ompl", "", "pilz_industrial_motion_planner"))
    planners = ("", "RRTConnect", "arm[RRTConnect]")
    if "pilz" in pilz:
        planners = ("PTP", "PTP", "LIN", "CIRC")
    return {
        "group_name": "arm",
        "pipeline_id": pilz,
        "planner_id": chance.choice(planners),
        "num_planning_attempts": chance.choice((0, 1, 2)),
        "allowed_planning_time": LONGEST_S,
        "max_velocity_scaling_factor": 0.5,
        "max_acceleration_scaling_factor": 0.5,
        "start_state": {} if pipeline else _state(chance),
        "goal_constraints": [_goal(chance) for _ in range(1 if "pilz" in pilz else 2)],
        "path_constraints": {
            "name": "",
            "orientation_constraints": [_orientation(chance)] if chance.random() < 0.1 else [],
        },
    }


def _plan(chance: random.Random) -> dict[str, Any]:
    return {"request": _request(chance), "diff": _scene(chance)}


def _sequence(chance: random.Random) -> dict[str, Any]:
    pilz = "pilz_industrial_motion_planner"
    items = [{"req": _request(chance, pilz), "blend_radius": 0.0} for _ in range(2)]
    items[0]["blend_radius"] = chance.choice((0.0, 0.02))
    return {"request": {"items": items}, "diff": _scene(chance)}


def _cartesian(chance: random.Random) -> dict[str, Any]:
    return {
        "header": {"frame_id": chance.choice(("l0", "", "l5"))},
        "start_state": _state(chance),
        "group_name": "arm",
        "link_name": "l5",
        "waypoints": [_pose(chance) for _ in range(chance.choice((1, 2)))],
        "max_step": 0.02,
        "jump_threshold": 0.0,
        "revolute_jump_threshold": 0.0,
        "avoid_collisions": True,
        "path_constraints": {},
        "max_velocity_scaling_factor": 0.0,
        "max_acceleration_scaling_factor": 0.0,
    }


def _inverse(chance: random.Random) -> dict[str, Any]:
    return {
        "ik_request": {
            "group_name": "arm",
            "robot_state": _state(chance),
            "constraints": {},
            "avoid_collisions": True,
            "ik_link_name": "l5",
            "pose_stamped": {"header": {"frame_id": "l0"}, "pose": _pose(chance)},
            "ik_link_names": [],
            "pose_stamped_vector": [],
            "timeout": {"sec": 0, "nanosec": 5_000_000},
        }
    }


def _forward(chance: random.Random) -> dict[str, Any]:
    names = ["l5", "l2", "box"][: chance.choice((1, 2, 2, 3))]
    return {"header": {"frame_id": "l0"}, "fk_link_names": names, "robot_state": _state(chance)}


def _validity(chance: random.Random) -> dict[str, Any]:
    return {"group_name": "arm", "robot_state": _state(chance), "constraints": _goal(chance)}


_KINDS: dict[str, Callable[[random.Random], dict[str, Any]]] = {
    "plan": _plan,
    "sequence": _sequence,
    "compute_cartesian_path": _cartesian,
    "compute_ik": _inverse,
    "compute_fk": _forward,
    "check_state_validity": _validity,
}


class _Monitor:
    """The present scene: what the scene monitor is to a session, without topics."""

    def __init__(self, planner: Planner) -> None:
        self._model, self.scene, self.states = planner.model, planner.scene, self

    def wait_for_fresh(self, *_: object) -> str:
        return ""

    def current(self) -> PlanningScene:
        return self.scene

    def with_frames(self, scene: PlanningScene, _: object) -> PlanningScene:
        return scene

    def applied(self, scene: PlanningScene, message: SceneMessage) -> SceneOutcome:
        change = scene_change_of(self._model, message, lambda _: None)
        return change_scene(self._model, scene, change, lambda _: None)


class _Session(PlanningSession):
    """Has little time for a plan, so that many requests are answered soon."""

    def request(self, message: MotionPlanRequest, scene: PlanningScene) -> PlanRequest:
        request = super().request(message, scene)
        return replace(request, allowed_time_s=min(request.allowed_time_s, LONGEST_S))


class _Node:
    """Takes services and publishers, as a node does; requests are put to it directly."""

    def __init__(self) -> None:
        self.services: dict[str, tuple[Any, Callable[[Any, Any], Any]]] = {}

    def create_service(self, kind: Any, name: str, serve: Any, **_: object) -> None:
        self.services[name] = (kind, serve)

    def create_publisher(self, *_: object) -> SimpleNamespace:
        return SimpleNamespace(get_subscription_count=lambda: 0)

    def get_clock(self) -> SimpleNamespace:
        from builtin_interfaces.msg import Time

        return SimpleNamespace(now=lambda: SimpleNamespace(to_msg=Time))


class Desk:
    """Answers the JSON of requests, each from the same scene, and checks the answers."""

    def __init__(self) -> None:
        planner = Planner.of_urdf(URDF, SRDF)
        setup = PlanningSetup(
            planner.model, planner.scene, "", MeshPieces(), CartesianLimits(), 0, in_world=None
        )
        self._session: Any = _Session(setup, _Monitor(planner))  # pyright: ignore[reportArgumentType]
        self._node: Any = _Node()
        display = PlanDisplay(self._node, planner.model)
        PlanningServices(self._node, self._session, display, BusyLimit(1))
        StateServices(self._node, self._session, BusyLimit(1), QuickServices())
        self._scene = planner.scene

    def answer(self, kind: str, data: bytes) -> bool:
        """Return whether a request succeeds; one that no message can hold does not."""
        given = json.loads(data)
        try:
            return self._answered(kind, given)
        except MessageValueError:
            return False

    def _answered(self, kind: str, given: dict[str, Any]) -> bool:
        if kind in ("plan", "sequence"):
            return self._planned(kind, given)
        service, serve = self._node.services[kind]
        request = fill_message(service.Request(), given).message
        answer = serve(request, service.Response())
        if kind == "check_state_validity":
            return answer.valid
        code = answer.error_code
        assert FAULT not in code.message, code.message
        assert code.message or code.val == SUCCESS
        if kind == "compute_cartesian_path":
            _check(answer.solution)
        if kind == "compute_ik" and code.val == SUCCESS:
            assert np.isfinite(answer.solution.joint_state.position).all()
        return code.val == SUCCESS

    def _planned(self, kind: str, given: dict[str, Any]) -> bool:
        diff = fill_message(SceneMessage(), given["diff"]).message
        if kind == "plan":
            request = fill_message(MotionPlanRequest(), given["request"]).message
            planned = self._session.plan(request, diff)
            trajectories = [planned.trajectory]
        else:
            request = fill_message(MotionSequenceRequest(), given["request"]).message
            planned = SequenceSession(self._session).plan(request, diff)
            trajectories = list(planned.trajectories)
        is_done = planned.code.value == SUCCESS
        assert is_done or planned.message
        for each in trajectories if is_done else ():
            assert each is not None
            assert np.isfinite(each.positions).all()
            assert (np.diff(each.times_s) > 0.0).all()
        return is_done


def _check(trajectory: RobotTrajectory) -> None:
    for point in trajectory.joint_trajectory.points:
        assert np.isfinite(point.positions).all()
