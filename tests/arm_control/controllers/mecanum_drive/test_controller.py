"""The mecanum drive on fake wheels: alone, and behind another controller."""

from math import inf, nan, pi
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from manager_bench import PERIOD_S, ManagerBench

from arm_control import ControllerContext
from arm_control.controllers.forward_command.controller import (
    ForwardCommandController,
    ForwardCommandParameters,
)
from arm_control.controllers.mecanum_drive.controller import MecanumDriveController
from arm_control.controllers.mecanum_drive.kinematics import (
    MecanumGeometry,
    MecanumOdometry,
    MecanumTwist,
)
from arm_control.errors import ControllerError, ControllerManagerError, ParameterError
from arm_control.manager.registry import controller_class
from arm_control.testing import fake_hardware

TYPE = "mecanum_drive_controller/MecanumDriveController"
JOINTS = ("fl", "fr", "rr", "rl")
NAMES = ("front_left", "front_right", "rear_right", "rear_left")
WHEELS = {
    f"{wheel}_wheel_command_joint_name": joint for wheel, joint in zip(NAMES, JOINTS, strict=True)
}
SIZES = {
    "kinematics.wheels_radius": 0.05,
    "kinematics.sum_of_robot_center_projection_on_X_Y_axis": 0.3,
}
numbers = st.floats(-5.0, 5.0)


class Sink:
    def __init__(self) -> None:
        self.odometry = MecanumOdometry()
        self.references: list[MecanumTwist] = []

    def publish(
        self, time_s: float, odometry: MecanumOdometry, wheels: Any, reference: MecanumTwist
    ) -> None:
        self.odometry = odometry
        self.references.append(reference)


class Bench(ManagerBench):
    """Four wheels that turn as commanded, and a controller for them."""

    def __init__(self) -> None:
        super().__init__(
            fake_hardware(JOINTS, command_interfaces=("velocity",), state_interfaces=("velocity",))
        )
        self.drive = MecanumDriveController(ControllerContext("base", 100))
        self.drive.sink = self.sink = Sink()
        self.manager.load_controller(self.drive, TYPE)

    def start(self, **values: Any) -> None:
        self.configure(**values)
        self.switch("base")
        self.tick()

    def configure(self, **values: Any) -> None:
        parameters = MecanumDriveController.build_parameters({**WHEELS, **SIZES, **values})
        self.manager.configure_controller("base", parameters)

    def move(self, period_s: float) -> None:
        self.hardware.states[:] = self.hardware.commands

    @property
    def wheels(self) -> list[float]:
        return self.hardware.commands.tolist()


@pytest.fixture
def bench() -> Bench:
    return Bench()


def test_the_registry_knows_it():
    assert controller_class(TYPE) is MecanumDriveController


@pytest.mark.parametrize(
    ("twist", "wheels"),
    [
        (MecanumTwist(x=0.5), [10.0, 10.0, 10.0, 10.0]),
        (MecanumTwist(y=0.5), [-10.0, 10.0, -10.0, 10.0]),
        (MecanumTwist(yaw=1.0), [-6.0, 6.0, 6.0, -6.0]),
    ],
)
def test_each_motion_turns_the_wheels_its_own_way(bench, twist, wheels):
    bench.start(reference_timeout=1.0)
    assert bench.drive.offer(twist, None) == ""
    bench.tick()
    assert bench.wheels == pytest.approx(wheels)
    assert bench.sink.references[-1] == twist


@given(numbers, numbers, numbers, numbers, numbers, st.floats(-pi, pi))
def test_the_twist_of_the_wheels_is_the_commanded_one(x, y, yaw, base_x, base_y, base_yaw):
    geometry = MecanumGeometry(0.05, 0.3, base_x, base_y, base_yaw)
    found = geometry.twist(geometry.wheel_velocities(MecanumTwist(x, y, yaw)))
    assert (found.x, found.y, found.yaw) == pytest.approx((x, y, yaw), abs=1e-9)


def test_a_base_frame_beside_the_centre_goes_round_it(bench):
    """A twist about the base frame's origin moves the centre sideways."""
    bench.start(**{"reference_timeout": 9.0, "kinematics.base_frame_offset.x": 0.1})
    bench.drive.offer(MecanumTwist(yaw=1.0), None)
    bench.tick()
    assert bench.wheels == pytest.approx([-4.0, 4.0, 8.0, -8.0])


def test_a_square_of_three_motions_closes(bench):
    bench.start(reference_timeout=9.0)
    legs = [MecanumTwist(x=1.0), MecanumTwist(y=1.0), MecanumTwist(yaw=pi), MecanumTwist(x=1.0)]
    for leg in [*legs, MecanumTwist(y=1.0)]:
        bench.drive.offer(leg, None)
        bench.tick(100)
    bench.drive.offer(MecanumTwist(), None)
    bench.tick(2)
    odometry = bench.sink.odometry
    assert (odometry.x, odometry.y) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert odometry.heading == pytest.approx(pi)


def test_an_arc_is_integrated_exactly():
    odometry = MecanumOdometry()
    for _ in range(4):
        odometry.move(MecanumTwist(x=1.0, yaw=pi / 2), 1.0)
    assert (odometry.x, odometry.y) == pytest.approx((0.0, 0.0), abs=1e-12)
    odometry.move(MecanumTwist(x=1.0, yaw=pi / 2), 1.0)
    assert (odometry.x, odometry.y) == pytest.approx((2 / pi, 2 / pi))


def test_without_a_timeout_a_reference_is_valid_for_one_cycle(bench):
    bench.start()
    bench.drive.offer(MecanumTwist(x=0.5), None)
    bench.tick()
    assert bench.wheels == [10.0] * 4
    bench.tick()
    assert bench.wheels == [0.0] * 4


def test_after_the_timeout_the_wheels_stand(bench):
    bench.start(reference_timeout=0.1)
    bench.drive.offer(MecanumTwist(x=0.5), None)
    bench.tick(10)
    assert bench.wheels == [10.0] * 4
    bench.tick(3)
    assert bench.wheels == [0.0] * 4


@pytest.mark.parametrize(
    ("twist", "stamp_s", "reason"),
    [
        (MecanumTwist(x=nan), None, "its velocities are x nan, y 0.0 and yaw 0.0, not finite"),
        (MecanumTwist(y=inf), None, "its velocities are x 0.0, y inf and yaw 0.0, not finite"),
        (MecanumTwist(), 0.5, "its stamp is 0.500 s old, and reference_timeout is 0.1 s"),
    ],
)
def test_a_useless_reference_is_refused(bench, twist, stamp_s, reason):
    bench.start(reference_timeout=0.1)
    bench.tick(100)
    assert bench.drive.offer(twist, stamp_s) == reason


def test_an_inactive_controller_takes_no_reference(bench):
    bench.start()
    bench.switch("", "base")
    assert bench.drive.offer(MecanumTwist(x=1.0), None) == "the controller is not active"


def test_another_controller_commands_it(bench):
    bench.configure()
    forward = ForwardCommandController(ControllerContext("forward", 100))
    bench.manager.load_controller(forward, "forward_command_controller/ForwardCommandController")
    bench.manager.configure_controller(
        "forward",
        ForwardCommandParameters(
            joints=("base/linear/x", "base/linear/y", "base/angular/z"), interface_name="velocity"
        ),
    )
    bench.switch("base forward")
    forward.offer([0.0, 0.5, 0.0])
    bench.tick(2)
    assert bench.wheels == pytest.approx([-10.0, 10.0, -10.0, 10.0])
    assert bench.drive.offer(MecanumTwist(), None) == "another controller commands this one"


def test_a_wheel_of_unknown_velocity_ends_it(bench):
    bench.start()
    bench.hardware.states[2] = nan
    bench.manager.read(bench.time_s, PERIOD_S)
    bench.manager.update(bench.time_s, PERIOD_S)
    assert np.array_equal(bench.hardware.commands, np.zeros(4))
    assert bench.drive.offer(MecanumTwist(), None) == "the controller is not active"


def test_values_that_make_no_sense_are_refused():
    with pytest.raises(ParameterError, match=r"'kinematics.wheels_radius' must be above 0"):
        MecanumDriveController.build_parameters(WHEELS)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"rear_left_wheel_command_joint_name": ""}, "'rear_left_wheel_command_joint_name' is emp"),
        ({"rear_left_wheel_command_joint_name": "fl"}, "need four joints, but they are fl, fr, rr"),
        ({"pose_covariance_diagonal": [1.0]}, "takes 6 numbers, not 1"),
    ],
)
def test_a_robot_that_cannot_drive_is_refused(bench, values, words):
    with pytest.raises(ControllerManagerError, match=words):
        bench.configure(**values)


def test_a_program_s_command_is_the_twist(bench):
    bench.start()
    bench.drive.take_command([0.1, 0.0, 0.0])
    bench.tick()
    assert bench.wheels == pytest.approx([2.0] * 4)
    with pytest.raises(ControllerError, match="a command has 3 values, not 2"):
        bench.drive.take_command([0.5, 0.5])
    with pytest.raises(ControllerError, match="a command was dropped: its velocities are"):
        bench.drive.take_command([nan, 0.0, 0.0])
