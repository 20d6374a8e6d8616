"""Where the simulated ROSMASTER X3 really goes, beside what its wheels say."""

import math
from pathlib import Path

import numpy as np
import pytest

from arm_control.controllers.mecanum_drive.kinematics import (
    MecanumGeometry,
    MecanumOdometry,
    MecanumTwist,
)
from arm_control.hardware.info import parse_hardware_info
from arm_description.urdf.parser import parse_urdf
from arm_description.xacro.expansion import expand_xacro
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.model.builder import build_model
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import physics_timing
from arm_gazebo.robot.gazebo_tags import parse_gazebo_tags
from arm_gazebo.robot.part import BuildOptions

RATE_HZ = 100.0
WHEELS = ("front_left", "front_right", "back_right", "back_left")
GEOMETRY = MecanumGeometry(0.0325, 0.1545)
AHEAD, LEFT = MecanumTwist(x=0.5), MecanumTwist(y=0.5)
BACK, RIGHT = MecanumTwist(x=-0.5), MecanumTwist(y=-0.5)
TURN = MecanumTwist(yaw=math.pi / 2)
STAND = MecanumTwist()


class Rosmaster:
    """The robot in an empty world, and what moves it."""

    def __init__(self) -> None:
        model = Path(__file__).parents[2] / "robots/yahboom_rosmaster_description/urdf/robots"
        urdf = expand_xacro(str(model / "rosmaster_x3.urdf.xacro"), {"use_gazebo": "true"})
        timing = physics_timing(RATE_HZ)
        [info] = parse_hardware_info(urdf)
        built = build_model(
            parse_urdf(urdf),
            [info],
            options=BuildOptions(step_s=timing.step_s, base="free"),
            tags=parse_gazebo_tags(urdf),
        )
        self.simulation = Physics(built, timing)
        self.body = built.bodies["base_footprint"]
        self.hardware = SimulatedHardware(self.simulation, info)
        self.states = np.zeros(len(self.hardware.state_interfaces))
        self.commands = np.zeros(len(self.hardware.command_interfaces))
        self.hardware.bind(self.states, self.commands)
        assert self.hardware.on_configure()
        assert self.hardware.on_activate()
        names = [f"{wheel}_wheel_joint/velocity" for wheel in WHEELS]
        assert self.hardware.prepare_command_mode_switch(names, [])
        assert self.hardware.perform_command_mode_switch(names, [])
        self.commanded = [list(self.hardware.command_interfaces).index(name) for name in names]
        self.measured = [list(self.hardware.state_interfaces).index(name) for name in names]
        self.odometry = MecanumOdometry()
        self.turned = 0.0

    def go(self, twist: MecanumTwist, seconds: float) -> None:
        for _ in range(round(seconds * RATE_HZ)):
            before = self.heading
            self.commands[self.commanded] = GEOMETRY.wheel_velocities(twist)
            self.hardware.write(self.simulation.time_s, 1 / RATE_HZ)
            self.simulation.advance()
            self.hardware.read(self.simulation.time_s, 1 / RATE_HZ)
            self.odometry.move(GEOMETRY.twist(self.states[self.measured]), 1 / RATE_HZ)
            self.turned += math.remainder(self.heading - before, math.tau)

    @property
    def heading(self) -> float:
        rotation = self.simulation.data.xmat[self.body]
        return math.atan2(rotation[3], rotation[0])

    @property
    def place(self) -> np.ndarray:
        return self.simulation.data.xpos[self.body][:2].copy()


@pytest.fixture
def rosmaster() -> Rosmaster:
    robot = Rosmaster()
    robot.go(STAND, 0.3)
    return robot


@pytest.mark.parametrize("leg", [AHEAD, LEFT, RIGHT], ids=["ahead", "left", "right"])
def test_a_metre_is_a_metre(rosmaster, leg):
    start = rosmaster.place
    rosmaster.go(leg, 2.0)
    rosmaster.go(STAND, 0.3)
    wanted = np.array([leg.x, leg.y]) * 2.0
    assert rosmaster.place - start == pytest.approx(wanted, abs=0.02)
    assert (rosmaster.odometry.x, rosmaster.odometry.y) == pytest.approx(wanted, abs=0.02)


def test_a_full_turn_is_a_full_turn(rosmaster):
    start = rosmaster.place
    rosmaster.go(TURN, 4.0)
    rosmaster.go(STAND, 0.3)
    assert rosmaster.turned == pytest.approx(math.tau, rel=0.02)
    assert rosmaster.odometry.heading == pytest.approx(math.tau, rel=0.02)
    assert rosmaster.place == pytest.approx(start, abs=0.01)


@pytest.mark.parametrize(
    "legs",
    [
        [(leg, seconds) for _ in range(4) for leg, seconds in ((AHEAD, 2.0), (TURN, 1.0))],
        [(AHEAD, 2.0), (LEFT, 2.0), (BACK, 2.0), (RIGHT, 2.0)],
        [(leg, seconds) for _ in range(4) for leg, seconds in ((LEFT, 2.0), (TURN, 1.0))],
    ],
    ids=["ahead and turn", "ahead and sideways", "sideways and turn"],
)
def test_a_square_of_one_metre_closes(rosmaster, legs):
    start = rosmaster.place
    for leg, seconds in legs:
        rosmaster.go(leg, seconds)
        rosmaster.go(STAND, 0.3)
    assert np.linalg.norm(rosmaster.place - start) < 0.03
