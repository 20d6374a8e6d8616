"""The pick in the simulation, with the controllers that run there, as fast as it goes.

Nothing tells the plan where the cylinder really stands, and nothing but friction holds it: success
is what its pose shows.
"""

import asyncio
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from arm_control import ControllerContext, ControllerManager
from arm_control.controller_switch import Strictness, SwitchRequest
from arm_control.goal_outcome import Outcome
from arm_control.gripper import GripperRequest
from arm_control.hardware_info import parse_hardware_info
from arm_control.joint_trajectory import GoalRequest, TrajectoryPoint, TrajectoryRequest
from arm_control.registry import controller_class
from arm_controller.arm_gripper_loop import ArmGripperLoop
from arm_controller.errors import PickError
from arm_controller.mycobot import JOINTS
from arm_controller.pick_and_place import Grip, PickAndPlace
from arm_controller.pick_plan import PickPlan, PickTask, plan_pick
from arm_controller.way import Way, WayPoint
from arm_description.resources import resolve_uri
from arm_description.robot import Pose
from arm_description.urdf import parse_urdf
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.launching.robot_setup import RobotSetup, set_up_robot
from arm_gazebo.model.builder import build_model
from arm_gazebo.physics.simulation import Simulation
from arm_gazebo.physics_timing import physics_timing
from arm_gazebo.robot.build_options import BuildOptions
from arm_gazebo.robot.gazebo_tags import parse_gazebo_tags

RATE_HZ = 100
BASE_HEIGHT_M = 0.025
OBJECT = "red_cylinder"
START = np.array([0.22, 0.12, 0.175])
SPREAD_M = 0.005
RUNS = 20
SEED = 280
LONGEST_S = 30.0
LOOP_S = 2.0
PADS = {"gripper_left1", "gripper_right1"}
ARM, GRIPPER = "arm_controller", "gripper_action_controller"


@pytest.fixture(scope="module")
def setup() -> RobotSetup:
    return set_up_robot(
        "package://mycobot_description/urdf/robots/mycobot_280.urdf.xacro",
        "use_gazebo:=true",
        str(
            resolve_uri(
                "package://mycobot_moveit_config/config/mycobot_280/ros2_controllers_template.yaml"
            )
        ),
    )


@pytest.fixture(scope="module")
def plan(setup: RobotSetup) -> PickPlan:
    return plan_pick(parse_urdf(setup.description), PickTask())


class Results:
    """What a controller's goals came to."""

    def __init__(self) -> None:
        self.by_goal: dict[object, Any] = {}

    def open(self, layout: object = None) -> None:
        pass

    def publish_state(self, state: object) -> None:
        pass

    def publish_feedback(self, goal_id: object, feedback: object) -> None:
        pass

    def finish_goal(self, goal_id: object, result: Any) -> None:
        self.by_goal[goal_id] = result


@dataclass
class Track:
    """What happened in all ticks: where the object was, and what the robot touched.

    Attributes:
        heights: of the object above its start, m.
        tilts: of the object, rad.
        touched: links of the robot, each with a thing that it touched.
    """

    heights: list[float]
    tilts: list[float]
    touched: set[tuple[str, str]]


class SteppedRobot:
    """A `PickingRobot`, and an `ArmWithGripper`, in the simulation; time passes while it moves.

    Args:
        setup: the robot.
        offset: of the object from where it stands by default, in m.
    """

    def __init__(self, setup: RobotSetup, offset: tuple[float, float] = (0.0, 0.0)) -> None:
        timing = physics_timing(RATE_HZ)
        hardware = parse_hardware_info(setup.description)
        built = build_model(
            parse_urdf(setup.description),
            hardware,
            world="pick_and_place_demo",
            options=BuildOptions(step_s=timing.step_s, spawn=Pose((0.0, 0.0, BASE_HEIGHT_M))),
            tags=parse_gazebo_tags(setup.description),
        )
        place = built.model.jnt_qposadr[built.model.body(OBJECT).jntadr[0]]
        qpos = built.qpos.copy()
        qpos[place : place + 2] += offset
        # Its link `world` is the world itself.
        self._links = set(built.bodies.values()) - {0}
        self.simulation = Simulation(replace(built, qpos=qpos), timing)
        self.track = Track([], [], set())
        self._places = self.simulation.data.xpos.copy()
        self.during: dict[str, slice] = {}
        parts = [SimulatedHardware(self.simulation, info) for info in hardware]
        self._manager = ControllerManager(parts, RATE_HZ)
        self._manager.bring_up()
        self._results = Results()
        self._controllers = {name: self._start(name, setup.controllers) for name in (ARM, GRIPPER)}

    def _start(self, name: str, content: Any) -> Any:
        type_name = content["controller_manager"]["ros__parameters"][name]["type"]
        controller: Any = controller_class(type_name)(ControllerContext(name, RATE_HZ))
        controller.sink = self._results
        self._manager.load_controller(controller, type_name)
        parameters = controller.build_parameters(content[name]["ros__parameters"])
        self._manager.configure_controller(name, parameters)
        request = SwitchRequest(activate=(name,), strictness=Strictness.STRICT)
        result = self._manager.switch_controller(request)
        assert result.ok, result.message
        return controller

    def tick(self) -> None:
        simulation, period_s = self.simulation, 1.0 / RATE_HZ
        self._manager.update(simulation.time_s, period_s)
        self._manager.write(simulation.time_s, period_s)
        simulation.advance()
        self._manager.read(simulation.time_s, period_s)
        body = simulation.data.body(OBJECT)
        self.track.heights.append(body.xpos[2] - START[2])
        self.track.tilts.append(np.arccos(min(1.0, body.xmat[8])))
        self.track.touched.update(self._touches())

    def _touches(self) -> Iterator[tuple[str, str]]:
        """Yield what touches the robot now: its link and the other body."""
        model, contacts = self.simulation.model, self.simulation.data.contact
        for bodies in model.geom_bodyid[contacts.geom]:
            ours = [body for body in bodies if body in self._links]
            others = [body for body in bodies if body not in self._links]
            if ours and others:
                yield model.body(ours[0]).name, model.body(others[0]).name

    def moved(self) -> set[str]:
        """Return the things that are not where they were: a touch between two ticks shows, too."""
        model, data = self.simulation.model, self.simulation.data
        ways = np.linalg.norm(data.xpos - self._places, axis=1)
        return {model.body(i).name for i in np.flatnonzero(ways > 2e-3) if i not in self._links}

    @property
    def object_position(self) -> np.ndarray:
        return self.simulation.data.body(OBJECT).xpos.copy()

    async def connect(self) -> None:
        pass

    async def follow(self, way: Way) -> str | None:
        points = [TrajectoryPoint(p.time_s, p.positions, p.velocities) for p in way]
        request = TrajectoryRequest(JOINTS, points)
        result = self._carry_out(ARM, lambda goal: GoalRequest(goal, request))
        return None if result.outcome is Outcome.SUCCEEDED else result.message

    async def grip(self, position: float, max_effort: float) -> Grip | str:
        result = self._carry_out(
            GRIPPER, lambda goal: GripperRequest(goal, [position], [max_effort])
        )
        return Grip(result.state.position, result.reached_goal, result.stalled)

    async def move_arm(self, positions: tuple[float, ...]) -> str | None:
        return await self.follow((WayPoint(LOOP_S, positions, ()),))

    async def move_gripper(self, position: float) -> str | None:
        grip = await self.grip(position, 5.0)
        return None if isinstance(grip, Grip) and grip.reached else f"stopped: {grip}"

    async def pause(self, seconds: float) -> None:
        before = len(self.track.heights)
        for _ in range(round(seconds * RATE_HZ)):
            self.tick()
        self.during["pause"] = slice(before, len(self.track.heights))

    def _carry_out(self, name: str, make_goal: Callable[[object], Any]) -> Any:
        goal = object()
        assert self._controllers[name].submit_goal(make_goal(goal)) is None
        end_s = self.simulation.time_s + LONGEST_S
        while goal not in self._results.by_goal:
            self.tick()
            assert self.simulation.time_s < end_s, f"{name} does not end its goal"
        return self._results.by_goal[goal]


def offsets() -> list[tuple[float, float]]:
    drawn = np.random.default_rng(SEED).uniform(-SPREAD_M, SPREAD_M, (RUNS - 4, 2))
    corners = [(x, y) for x in (-SPREAD_M, SPREAD_M) for y in (-SPREAD_M, SPREAD_M)]
    return [*corners, *((float(x), float(y)) for x, y in drawn)]


def assert_held_and_put_back(robot: SteppedRobot, task: PickTask) -> None:
    heights = np.array(robot.track.heights[robot.during["pause"]])
    assert len(heights) == task.hold_s * RATE_HZ
    assert heights == pytest.approx(task.lift, abs=2e-3), "it was lifted, and stayed there"
    assert np.ptp(heights) < 5e-4, "it did not slip"
    assert max(robot.track.tilts) < np.radians(5.0), "it never fell"
    assert robot.track.tilts[-1] < np.radians(1.0), "it stands again"
    assert robot.object_position == pytest.approx(START, abs=0.012), "where it stood"
    assert robot.track.touched == {(pad, OBJECT) for pad in PADS}, "nothing else was touched"
    assert robot.moved() <= {OBJECT}


@pytest.mark.parametrize("offset", offsets(), ids=lambda o: f"{o[0] * 1e3:.1f}_{o[1] * 1e3:.1f}mm")
def test_the_cylinder_is_lifted_held_and_put_back_wherever_it_stands(setup, plan, offset):
    robot = SteppedRobot(setup, offset)
    asyncio.run(PickAndPlace(robot, plan).run())
    assert_held_and_put_back(robot, plan.task)


def test_a_hard_grip_holds_as_well(setup, plan):
    robot = SteppedRobot(setup, (0.003, -0.004))
    hard = replace(plan, task=replace(plan.task, max_effort=8.0))
    asyncio.run(PickAndPlace(robot, hard).run())
    assert_held_and_put_back(robot, plan.task)


def test_nothing_but_friction_lifts_it(setup, plan):
    robot = SteppedRobot(setup)
    robot.simulation.model.geom_friction[:, 0] = 0.01
    asyncio.run(PickAndPlace(robot, plan).run())
    assert max(robot.track.heights) < 0.01


def test_an_object_that_is_not_there_is_missed(setup, plan):
    robot = SteppedRobot(setup, (0.0, -0.4))
    with pytest.raises(PickError, match="nothing between the fingers: they closed all the way"):
        asyncio.run(PickAndPlace(robot, plan).run())
    assert max(map(abs, robot.track.heights)) < 1e-3


def test_the_loop_of_arm_and_gripper_touches_nothing(setup, caplog):
    robot = SteppedRobot(setup)
    caplog.clear()
    asyncio.run(ArmGripperLoop(robot).run_once())
    asyncio.run(ArmGripperLoop(robot).run_once())
    assert caplog.messages == [], "every place was reached"
    assert robot.track.touched == set()
    assert robot.moved() == set()


def test_a_thing_in_the_way_of_the_loop_is_seen_to_be_hit(setup):
    robot = SteppedRobot(setup, (-0.48, -0.03))
    asyncio.run(ArmGripperLoop(robot).run_once())
    assert robot.moved() == {OBJECT}
