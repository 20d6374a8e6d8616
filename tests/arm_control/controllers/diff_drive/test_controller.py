"""The differential drive on fake wheels: alone, and behind another controller."""

from math import inf, nan, pi
from typing import Any

import pytest
from manager_bench import PERIOD_S, ManagerBench

from arm_control import ControllerContext
from arm_control.controllers.diff_drive.controller import DiffDriveController
from arm_control.controllers.diff_drive.odometry import PlanarPose, PlanarTwist
from arm_control.controllers.forward_command.controller import (
    ForwardCommandController,
    ForwardCommandParameters,
)
from arm_control.errors import ControllerError, ControllerManagerError, ParameterError
from arm_control.manager.registry import controller_class, controller_types, is_chainable
from arm_control.testing import fake_hardware

LEFT, RIGHT = ["left_front", "left_back"], ["right_front", "right_back"]
WHEELS = {"left_wheel_names": LEFT, "right_wheel_names": RIGHT}
SIZES = {"wheel_separation": 0.4, "wheel_radius": 0.1}


class Sink:
    def __init__(self) -> None:
        self.odometry: list[tuple[float, PlanarPose, PlanarTwist]] = []
        self.commands: list[PlanarTwist] = []

    def publish_odometry(self, time_s: float, pose: PlanarPose, twist: PlanarTwist) -> None:
        self.odometry.append((time_s, pose, twist))

    def publish_command(self, time_s: float, twist: PlanarTwist) -> None:
        self.commands.append(twist)

    @property
    def pose(self) -> PlanarPose:
        return self.odometry[-1][1]


class Bench(ManagerBench):
    """Four wheels that follow their commands, and a controller for them."""

    def __init__(self) -> None:
        super().__init__(
            fake_hardware(
                (*LEFT, *RIGHT),
                command_interfaces=("velocity",),
                state_interfaces=("position", "velocity"),
            )
        )
        self.drive = DiffDriveController(ControllerContext("base", 100))
        self.drive.sink = self.sink = Sink()
        self.manager.load_controller(self.drive, "diff_drive_controller/DiffDriveController")

    def start(self, **values: Any) -> None:
        parameters = DiffDriveController.build_parameters({**WHEELS, **SIZES, **values})
        self.manager.configure_controller("base", parameters)
        self.switch("base")
        self.tick()

    def go(self, linear: float, angular: float, stamp_s: float | None = None) -> str:
        return self.drive.offer(PlanarTwist(linear, angular), stamp_s)

    def move(self, period_s: float) -> None:
        states = self.hardware.states.reshape(4, 2)
        states[:, 0] += self.hardware.commands * period_s
        states[:, 1] = self.hardware.commands

    @property
    def wheels(self) -> list[float]:
        return self.hardware.commands.tolist()


@pytest.fixture
def bench() -> Bench:
    return Bench()


def test_the_wheels_of_a_side_turn_alike_and_the_sides_by_the_twist(bench):
    bench.start()
    assert bench.go(0.5, 1.0) == ""
    bench.tick()
    assert bench.wheels == pytest.approx([3.0, 3.0, 7.0, 7.0])


def test_the_multipliers_correct_the_sizes(bench):
    bench.start(
        wheel_separation_multiplier=2.0,
        left_wheel_radius_multiplier=0.5,
        right_wheel_radius_multiplier=2.0,
    )
    bench.go(0.5, 1.0)
    bench.tick()
    assert bench.wheels == pytest.approx([2.0, 2.0, 4.5, 4.5])


@pytest.mark.parametrize(
    "feedback", [{}, {"position_feedback": False}, {"open_loop": True}], ids=str
)
def test_odometry_follows_a_half_circle(bench, feedback):
    bench.start(cmd_vel_timeout=0.0, publish_rate=100.0, **feedback)
    bench.go(0.2, 0.5)
    bench.tick(round(pi / 0.5 / PERIOD_S) + 1)
    pose = bench.sink.pose
    assert (pose.x, pose.y) == pytest.approx((0.0, 0.8), abs=0.002)
    assert pose.heading == pytest.approx(pi, abs=0.005)
    assert bench.sink.odometry[-1][2].linear == pytest.approx(0.2)
    assert bench.sink.odometry[-1][2].angular == pytest.approx(0.5)


def test_the_odometry_of_a_cycle_is_stamped_with_what_it_shows(bench):
    bench.start(publish_rate=100.0)
    bench.go(1.0, 0.0)
    started_s = bench.time_s
    bench.tick(5)
    time_s, pose, _ = bench.sink.odometry[-1]
    assert pose.x == pytest.approx(time_s - started_s)


def test_odometry_comes_at_its_own_rate(bench):
    bench.start(publish_rate=20.0)
    bench.tick(99)
    assert len(bench.sink.odometry) == 20


def test_without_a_new_command_the_robot_stops_at_the_time_out(bench):
    bench.start(cmd_vel_timeout=0.25)
    bench.go(0.5, 0.0)
    bench.tick(24)
    assert bench.wheels == pytest.approx([5.0] * 4)
    bench.tick(3)
    assert bench.wheels == [0.0] * 4


def test_the_time_out_counts_from_the_stamp(bench):
    bench.start(cmd_vel_timeout=0.25)
    bench.tick(100)
    assert bench.go(0.5, 0.0, stamp_s=bench.time_s - 0.2) == ""
    bench.tick(4)
    assert bench.wheels == pytest.approx([5.0] * 4)
    bench.tick(4)
    assert bench.wheels == [0.0] * 4


def test_a_command_older_than_the_time_out_is_refused(bench):
    bench.start()
    bench.tick(200)
    assert "1.000 s old, and cmd_vel_timeout is 0.5 s" in bench.go(
        0.5, 0.0, stamp_s=bench.time_s - PERIOD_S - 1.0
    )
    bench.tick()
    assert bench.wheels == [0.0] * 4


def test_a_stamp_of_another_clock_does_not_put_off_the_time_out(bench):
    bench.start()
    assert bench.go(0.5, 0.0, stamp_s=1.8e9) == ""
    bench.tick(49)
    assert bench.wheels == pytest.approx([5.0] * 4)
    bench.tick(5)
    assert bench.wheels == [0.0] * 4


def test_a_clock_that_is_set_back_stops_the_robot(bench):
    bench.tick(1000)
    bench.start(cmd_vel_timeout=0.0)
    bench.go(0.5, 0.0)
    bench.tick()
    bench.time_s = 0.0
    bench.tick()
    assert bench.wheels == [0.0] * 4


def test_without_a_time_out_a_command_stays_valid(bench):
    bench.start(cmd_vel_timeout=0.0)
    bench.go(0.5, 0.0)
    bench.tick(1000)
    assert bench.wheels == pytest.approx([5.0] * 4)


@pytest.mark.parametrize("speeds", [(nan, 0.0), (0.1, nan), (inf, 0.0), (0.0, -inf), (1e308, 0.0)])
def test_a_value_that_is_not_a_number_or_too_large_is_refused_and_changes_nothing(bench, speeds):
    bench.start()
    bench.go(0.5, 0.0)
    bench.tick()
    assert "no wheel speed gives" in bench.go(*speeds)
    bench.tick()
    assert bench.wheels == pytest.approx([5.0] * 4)


def test_limits_bound_what_is_commanded_and_that_can_be_published(bench):
    limits = {"linear.x.max_velocity": 0.4, "angular.z.max_acceleration": 2.0}
    bench.start(publish_limited_velocity=True, **limits)
    bench.go(3.0, 1.0)
    bench.tick(2)
    assert bench.sink.commands[-1] == PlanarTwist(0.4, pytest.approx(0.04))
    assert bench.wheels == pytest.approx([3.92, 3.92, 4.08, 4.08])


def test_changed_limits_begin_at_the_present_speed(bench):
    bench.start()
    bench.go(0.5, 0.0)
    bench.tick()
    values = {**WHEELS, **SIZES, "linear.x.max_acceleration": 1.0}
    bench.drive.update_parameters(DiffDriveController.build_parameters(values))
    bench.go(0.0, 0.0)
    bench.tick()
    assert bench.wheels == pytest.approx([4.9] * 4)


def test_a_deactivated_controller_stops_and_takes_no_commands(bench):
    bench.start()
    bench.go(0.5, 0.0)
    bench.tick()
    bench.switch("", "base")
    assert bench.wheels == [0.0] * 4
    assert bench.go(0.5, 0.0) == "the controller is not active"


def test_the_pose_survives_a_deactivation_in_which_the_wheels_turn(bench):
    bench.start(publish_rate=100.0)
    bench.go(1.0, 0.0)
    bench.tick(11)
    assert bench.sink.pose.x == pytest.approx(0.1)
    bench.switch("", "base")
    bench.hardware.states[:] += 50.0
    bench.switch("base")
    bench.tick(2)
    assert bench.sink.pose.x == pytest.approx(0.1)
    assert bench.sink.odometry[-1][2] == PlanarTwist(0.0, 0.0)
    assert bench.wheels == [0.0] * 4


def test_a_wheel_that_is_lost_stops_the_controller(bench, caplog):
    bench.start()
    bench.hardware.states[4] = nan
    bench.tick()
    assert "cannot be updated: right_front/position is not a number" in caplog.text
    (status,) = bench.manager.list_controllers()
    assert status.state.label == "inactive"


def test_another_controller_may_command_the_speeds(bench):
    parameters = DiffDriveController.build_parameters({**WHEELS, **SIZES})
    bench.manager.configure_controller("base", parameters)
    ahead = ForwardCommandController(ControllerContext("ahead", 100))
    bench.manager.load_controller(ahead, "forward_command_controller/ForwardCommandController")
    bench.manager.configure_controller(
        "ahead", ForwardCommandParameters(("base/linear", "base/angular"), "velocity")
    )
    bench.switch("ahead base")
    bench.tick()
    assert bench.wheels == [0.0] * 4
    assert ahead.offer([0.5, 1.0])
    bench.tick()
    assert bench.wheels == pytest.approx([3.0, 3.0, 7.0, 7.0])
    assert bench.go(0.1, 0.0) == "another controller commands this one"


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        (
            {"left_wheel_names": ["a"]},
            "the same number of wheels, at least one each; they name 1 and 2",
        ),
        ({"left_wheel_names": [], "right_wheel_names": []}, "they name 0 and 0"),
        ({"wheels_per_side": 1}, "'wheels_per_side' is 1, but 2 wheels are named"),
        ({"wheel_radius": 0.0}, "'wheel_radius' must be above 0, but is 0"),
        ({"wheel_separation": nan}, "'wheel_separation' must be above 0, but is nan"),
        ({"left_wheel_radius_multiplier": -1.0}, "must be above 0, but is -1"),
        ({"cmd_vel_timeout": -0.1}, "'cmd_vel_timeout' must be at least 0"),
        ({"pose_covariance_diagonal": [1.0]}, "takes 6 numbers, not 1"),
        ({"publish_rate": 0.0}, "'publish_rate' must be above 0"),
        ({"velocity_rolling_window_size": 0}, "must be above 0"),
        ({"angular.z.max_velocity": -1.0}, r"'angular\.z\.max_velocity' is -1"),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else "",
)
def test_parameters_that_make_no_sense_are_refused(values, sentence):
    with pytest.raises((ParameterError, ControllerError), match=sentence):
        DiffDriveController.build_parameters({**WHEELS, **SIZES, **values}).check_robot()


def test_a_robot_that_cannot_drive_is_not_configured(bench):
    parameters = DiffDriveController.build_parameters({**WHEELS, **SIZES, "left_wheel_names": []})
    with pytest.raises(ControllerManagerError, match="they name 0 and 2"):
        bench.manager.configure_controller("base", parameters)


def test_deprecated_parameters_are_named_at_the_configuration(bench, caplog):
    bench.start(**{"linear.x.has_jerk_limits": False, "angular.z.min_acceleration": -1.0})
    assert "'linear.x.has_jerk_limits' is deprecated" in caplog.text
    assert "'angular.z.min_acceleration' is deprecated" in caplog.text


@pytest.mark.parametrize(
    ("values", "namespace", "expected"),
    [
        ({}, "/", "odom"),
        ({}, "/left/base", "left/base/odom"),
        ({"tf_frame_prefix": "robot"}, "/left", "robot/odom"),
        ({"tf_frame_prefix": "/robot/"}, "/", "robot/odom"),
        ({"tf_frame_prefix_enable": False, "tf_frame_prefix": "robot"}, "/left", "odom"),
    ],
)
def test_frames_have_the_prefix_or_the_namespace(values, namespace, expected):
    parameters = DiffDriveController.build_parameters({**WHEELS, **SIZES, **values})
    assert parameters.frame("odom", namespace) == expected


def test_it_is_found_by_ros2_control_s_name_for_it():
    type_name = "diff_drive_controller/DiffDriveController"
    assert type_name in controller_types()
    assert controller_class(type_name) is DiffDriveController
    assert is_chainable(type_name)


def test_a_program_s_command_is_the_twist(bench):
    bench.start()
    bench.drive.take_command([0.5, 1.0])
    bench.tick()
    assert bench.wheels == pytest.approx([3.0, 3.0, 7.0, 7.0])
    with pytest.raises(ControllerError, match="a command has 2 values, not 1"):
        bench.drive.take_command([0.5])
    with pytest.raises(ControllerError, match="a command was dropped: no wheel speed gives"):
        bench.drive.take_command([nan, 0.0])
