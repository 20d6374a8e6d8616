"""Robots whose runs are saved and restored: all that the node runs, without ROS."""

import logging
from collections.abc import Callable, Mapping
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from arm_control import ControllerContext, ControllerManager
from arm_control.controllers.goals import GoalOutcome
from arm_control.controllers.gripper.goals import GripperRequest
from arm_control.controllers.joint_trajectory.goals import GoalRequest
from arm_control.controllers.joint_trajectory.trajectory import TrajectoryPoint, TrajectoryRequest
from arm_control.hardware.info import parse_hardware_info
from arm_control.manager.registry import controller_class
from arm_control.manager.switch_planner import Strictness, SwitchRequest
from arm_controller.pick_and_place_node import PickAndPlace
from arm_controller.pick_plan import JOINTS, PickTask, plan_pick
from arm_description.resources import resolve_uri
from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Pose
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.hardware.simulated_sensors import SensorFeed, SimulatedSensor
from arm_gazebo.launching.robot_setup import RobotSetup, set_up_robot
from arm_gazebo.model.builder import build_model
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics.tick import SimulationTick
from arm_gazebo.physics_timing import physics_timing
from arm_gazebo.robot.gazebo_tags import parse_gazebo_tags
from arm_gazebo.robot.part import BuildOptions
from arm_gazebo.sensors.reader import parse_link_sensors
from arm_gazebo.state.complete_state import CompleteState

RATE_HZ = 100
LOGGER = logging.getLogger("pick")
IMU = """<gazebo reference="{link}"><sensor name="imu" type="imu"><update_rate>40</update_rate>
  <topic>imu</topic><imu><angular_velocity><x><noise type="gaussian"><stddev>0.01</stddev>
  <bias_stddev>0.01</bias_stddev></noise></x></angular_velocity></imu></sensor></gazebo>"""
TRAJECTORY = ("joint_trajectory_controller/JointTrajectoryController", {
    "joints": ["j0", "j1", "j2", "j3"],
    "command_interfaces": ["position"],
    "state_interfaces": ["position", "velocity"],
    "action_monitor_rate": 20.0,
})  # fmt: skip
BROADCASTER = ("joint_state_broadcaster/JointStateBroadcaster", {})


@cache
def _mycobot_setup() -> RobotSetup:
    controllers = "config/mycobot_280/ros2_controllers_template.yaml"
    return set_up_robot(
        "package://mycobot_description/urdf/robots/mycobot_280.urdf.xacro",
        "use_gazebo:=true",
        str(resolve_uri(f"package://mycobot_moveit_config/{controllers}")),
    )


class Results:
    """What controllers and sensors publish: how goals end, and each reading."""

    def __init__(self) -> None:
        self.by_goal: dict[object, Any] = {}
        self.readings: list[tuple[float, bytes]] = []
        self.states: list[bytes] = []

    def open(self, layout: object = None) -> None:
        pass

    def publish_state(self, state: Any) -> None:
        self.states.append(state.values.tobytes())

    def publish_feedback(self, goal_id: object, feedback: object) -> None:
        pass

    def finish_goal(self, goal_id: object, result: Any) -> None:
        self.by_goal[goal_id] = result

    def wanted(self) -> bool:
        return True

    def publish(self, time_s: float, *values: np.ndarray) -> None:
        self.readings.append((time_s, b"".join(value.tobytes() for value in values)))


class Silent:
    """A clock that nobody hears."""

    def publish(self, time_s: float) -> None:
        pass


class RunningRobot:
    """One robot in a world with its controllers and sensors, stepped by `run`."""

    def __init__(
        self,
        urdf: str,
        controllers: Mapping[str, tuple[str, Mapping[str, Any]]],
        world: str = "empty",
        **options: Any,
    ) -> None:
        timing = physics_timing(RATE_HZ)
        hardware, robot = parse_hardware_info(urdf), parse_urdf(urdf)
        described = parse_link_sensors(urdf, robot)
        built = build_model(
            robot,
            hardware,
            world=world,
            options=BuildOptions(step_s=timing.step_s, **options),
            tags=parse_gazebo_tags(urdf),
            sensors=described,
        )
        self.simulation = Physics(built, timing)
        sensors = [SimulatedSensor(self.simulation, sensor, seed=7) for sensor in described]
        self.hardware = [SimulatedHardware(self.simulation, info, sensors) for info in hardware]
        self.manager = ControllerManager(self.hardware, RATE_HZ)
        self.manager.bring_up()
        self.results = Results()
        self.controllers: dict[str, Any] = {}
        for name, (type_name, parameters) in controllers.items():
            self.start(name, type_name, parameters)
        feed = SensorFeed(sensors, [self.results] * len(sensors), timing.period_s)
        self._tick = SimulationTick([self.manager], self.simulation, Silent())
        self._tick.add_feed(feed)
        self.state = CompleteState(self.simulation, [self.manager])
        self.state.add_schedule(feed.schedule)

    def start(self, name: str, type_name: str, parameters: Mapping[str, Any]) -> None:
        """Load, configure and activate a controller."""
        made: Any = controller_class(type_name)(ControllerContext(name, RATE_HZ))
        self.add(made, type_name, made.build_parameters(parameters))

    def add(self, controller: Any, type_name: str, parameters: object) -> None:
        controller.sink = self.results
        self.manager.load_controller(controller, type_name)
        self.manager.configure_controller(controller.name, parameters)
        self.controllers[controller.name] = controller
        wanted = set(controller.command_interface_configuration().names)
        others = self.manager.list_controllers()
        busy = tuple(c.name for c in others if wanted & set(c.claimed_interfaces))
        self.switch(activate=(controller.name,), deactivate=busy)

    def switch(self, **names: tuple[str, ...]) -> None:
        result = self.manager.switch_controller(
            SwitchRequest(**names, strictness=Strictness.STRICT)
        )
        assert result.ok, result.message

    def run(self, ticks: int) -> list[bytes]:
        """Run; return a hash of the state after each tick."""
        digests = []
        for _ in range(ticks):
            self._tick()
            digests.append(self.state.digest())
        return digests

    def move(
        self, *positions: float, seconds: float = 1.0, goal: object = b"goal", name: str = "arm"
    ) -> None:
        """Start a trajectory goal that ends there."""
        joints = self.controllers[name].state_layout.joints
        request = TrajectoryRequest(joints, [TrajectoryPoint(seconds, positions)])
        assert self.controllers[name].submit_goal(GoalRequest(goal, request)) is None

    def grip(self, position: float, goal: object = b"grip", name: str = "gripper") -> None:
        assert self.controllers[name].submit_goal(GripperRequest(goal, [position], [5.0])) is None

    def positions(self) -> np.ndarray:
        return self.simulation.data.qpos.copy()

    def restore(self, saved: bytes) -> None:
        self.state.restore(saved)


class Reached(Exception):
    """The tick up to which a pick was to run."""


class Picking:
    """Stands for `ArmActions`, and runs up to a tick. Its goals are those of a pick."""

    def __init__(self, robot: RunningRobot, ticks: int) -> None:
        self._robot = robot
        self._left = ticks
        self._goals = 0

    def connect(self) -> None:
        pass

    def follow(self, path: Any) -> str | None:
        points = [TrajectoryPoint(p.time_s, p.positions, p.velocities) for p in path]
        request = TrajectoryRequest(JOINTS, points)
        result = self._carry_out("arm", lambda goal: GoalRequest(goal, request))
        return None if result.outcome is GoalOutcome.SUCCEEDED else result.message

    def grip(self, position: float, max_effort: float) -> SimpleNamespace:
        result = self._carry_out(
            "gripper", lambda goal: GripperRequest(goal, [position], [max_effort])
        )
        return SimpleNamespace(
            position=result.state.position, reached_goal=result.reached_goal, stalled=result.stalled
        )

    def pause(self, seconds: float) -> None:
        self._run(round(seconds * RATE_HZ))

    def _carry_out(self, name: str, make_goal: Callable[[bytes], Any]) -> Any:
        self._goals += 1
        goal = b"goal %d" % self._goals
        assert self._robot.controllers[name].submit_goal(make_goal(goal)) is None
        while goal not in self._robot.results.by_goal:
            self._run(1)
        return self._robot.results.by_goal[goal]

    def _run(self, ticks: int) -> None:
        for _ in range(ticks):
            if not self._left:
                raise Reached
            self._robot.run(1)
            self._left -= 1


@pytest.fixture
def pick() -> Callable[[RunningRobot, int], None]:
    """Return a function that runs the first ticks of a pick."""
    plan = plan_pick(_mycobot_setup().description, PickTask())

    def run(robot: RunningRobot, ticks: int) -> None:
        with pytest.raises(Reached):
            PickAndPlace(Picking(robot, ticks), plan, LOGGER).run()

    return run


@pytest.fixture
def robot() -> type[RunningRobot]:
    return RunningRobot


@pytest.fixture
def arm(parts: Any) -> Callable[..., RunningRobot]:
    """Return a maker of 4-DOF arms with a trajectory controller and a noisy IMU."""

    def make(world: str = "empty", **more: tuple[str, Mapping[str, Any]]) -> RunningRobot:
        urdf = parts.arm().replace("</robot>", IMU.format(link="l3") + "</robot>")
        controllers = {"joint_states": BROADCASTER, "arm": TRAJECTORY, **more}
        return RunningRobot(urdf, controllers, world)

    return make


@pytest.fixture
def mycobot() -> Callable[[], RunningRobot]:
    """Return a maker of myCobots with gripper, in front of the things of its pick."""
    setup = _mycobot_setup()
    content: Any = setup.controllers
    types = content["controller_manager"]["ros__parameters"]
    controllers = {
        short: (types[name]["type"], content[name]["ros__parameters"])
        for short, name in (("arm", "arm_controller"), ("gripper", "gripper_action_controller"))
    }

    def make() -> RunningRobot:
        return RunningRobot(
            setup.description,
            {"joint_states": BROADCASTER, **controllers},
            "pick_and_place_demo",
            spawn=Pose((0.0, 0.0, 0.025)),
        )

    return make
