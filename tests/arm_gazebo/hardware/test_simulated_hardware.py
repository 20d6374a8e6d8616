import math

import numpy as np
import pytest

from arm_control.hardware.driver import HardwareReturn
from arm_control.hardware.info import parse_hardware_info
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware


def test_interfaces_stand_in_the_description_s_order(bench, parts):
    hardware = bench(parts.arm()).hardware
    assert hardware.state_interfaces == hardware.info.state_interface_names
    assert hardware.command_interfaces == hardware.info.command_interface_names


def test_states_start_at_the_initial_values(bench, parts):
    arm = bench(parts.arm(j0_pos="0.1", j1_pos="0.5", j2_pos="0.4", j3_pos="1.0"))
    assert arm.state("position") == pytest.approx([0.1, 0.5, 0.4, 1.0])
    assert arm.state("velocity") == pytest.approx([0, 0, 0, 0])


def test_states_that_are_not_in_one_row_are_found_all_the_same(bench, parts):
    urdf = parts.robot(
        parts.link("base"),
        parts.link("a", 1, 0.1),
        parts.link("b", 1, 0.1),
        parts.joint("ja", "base", "a"),
        parts.joint("jb", "a", "b"),
        '<ros2_control name="sim" type="system"><hardware><plugin>p</plugin></hardware>'
        '<joint name="jb"><state_interface name="effort"/><state_interface name="position">'
        '<param name="initial_value">0.2</param></state_interface></joint>'
        '<joint name="ja"><state_interface name="position"><param name="initial_value">-0.7</param>'
        "</state_interface></joint></ros2_control>",
    )
    assert bench(urdf).state("position") == pytest.approx([0.2, -0.7])


def test_effort_state_is_what_the_drive_exerts(bench, parts):
    pendulum = bench(parts.pendulum())
    pendulum.run(1.0)
    assert pendulum.state("effort") == pytest.approx([-0.5 * 9.81], rel=1e-4)


def test_commands_start_at_the_joints_positions(bench, parts):
    arm = bench(parts.arm(j1_pos="0.5"))
    arm.claim()
    assert arm.commanded == pytest.approx([0, 0.5, 0, 0])


def test_unclaimed_joints_hold(bench, parts):
    arm = bench(parts.arm(j1_pos="0.5", j2_pos="0.5", j3_pos="1.0"))
    assert arm.run(2.0)[-1] == pytest.approx([0, 0.5, 0.5, 1.0], abs=1e-4)


def test_unclaimed_joints_fall_without_hold_joints(bench, parts):
    arm = bench(parts.arm(j1_pos="0.5"), hold_joints=False)
    assert arm.run(1.0)[-1, 1] > 1.5
    assert arm.state("effort") == pytest.approx([0, 0, 0, 0], abs=1e-12)


def test_claiming_catches_a_falling_joint(bench, parts):
    pendulum = bench(parts.pendulum(), hold_joints=False)
    pendulum.run(0.2)
    pendulum.claim()
    stopped = pendulum.commanded[0]
    assert pendulum.run(2.0)[-1] == pytest.approx([stopped], abs=1e-3)


def test_released_joint_falls_again_without_hold_joints(bench, parts):
    pendulum = bench(parts.pendulum(), hold_joints=False)
    pendulum.claim()
    pendulum.run(1.0)
    pendulum.release()
    assert pendulum.run(0.5)[-1, 0] > 0.5


@pytest.mark.parametrize("leave", ["on_deactivate", "on_cleanup", "on_shutdown"])
def test_a_deactivated_component_releases_its_joints(bench, parts, leave):
    pendulum = bench(parts.pendulum(), hold_joints=False)
    pendulum.claim()
    pendulum.run(0.5)
    assert getattr(pendulum.hardware, leave)()
    assert pendulum.run(0.5)[-1, 0] > 0.5


@pytest.mark.parametrize("interface", ["position", "velocity"])
def test_a_component_that_is_active_again_obeys_what_is_claimed(bench, parts, interface):
    pendulum = bench(parts.pendulum())
    pendulum.claim(interface)
    pendulum.command(0.3)
    pendulum.run(1.0)
    assert pendulum.hardware.on_deactivate()
    before = pendulum.state("position")
    pendulum.command(0.8)
    assert pendulum.run(0.5)[-1] == pytest.approx(before, abs=0.02)
    assert pendulum.hardware.on_activate()
    # What was commanded meanwhile is forgotten; the next command counts.
    before = pendulum.run(0.3)[-1]
    assert pendulum.run(0.5)[-1] == pytest.approx(before, abs=1e-3)
    pendulum.command(0.8)
    assert pendulum.run(0.5)[-1, 0] > before[0] + 0.2


def test_interfaces_may_be_claimed_before_the_component_is_active(bench, parts):
    pendulum = bench(parts.pendulum())
    assert pendulum.hardware.on_deactivate()
    pendulum.claim()
    assert pendulum.hardware.on_activate()
    pendulum.command(0.4)
    assert pendulum.run(1.5)[-1] == pytest.approx([0.4], abs=1e-3)


def test_joint_released_in_motion_stops_and_holds(bench, parts):
    pendulum = bench(parts.pendulum())
    pendulum.claim()
    pendulum.command(2.0)
    pendulum.run(0.5)
    pendulum.release()
    pendulum.run(1.0)
    positions = pendulum.run(1.0)
    assert 0.5 < positions[-1, 0] < 1.9
    assert np.ptp(positions) < 1e-4


def test_velocity_command_is_kept_under_gravity(bench, parts):
    pendulum = bench(parts.pendulum())
    pendulum.claim("velocity")
    pendulum.command(-0.5)
    pendulum.run(0.5)
    before = pendulum.state("position")[0]
    after = pendulum.run(2.0)[-1, 0]
    assert after - before == pytest.approx(-1.0, abs=2e-3)


def test_velocity_stops_at_the_limit(bench, parts):
    pendulum = bench(parts.pendulum(limit='lower="-1" upper="1" effort="20" velocity="3"'))
    pendulum.claim("velocity")
    pendulum.command(2.0)
    positions = pendulum.run(2.0)
    assert positions.max() < 1.003
    assert positions[-1] == pytest.approx([1.0], abs=2e-3)


def test_velocity_zero_holds_without_creeping(bench, parts):
    pendulum = bench(parts.pendulum())
    pendulum.claim("velocity")
    pendulum.run(0.5)
    assert np.ptp(pendulum.run(5.0)) < 1e-4


def test_effort_command_is_exerted(bench, parts):
    pendulum = bench(parts.pendulum())
    pendulum.claim("effort")
    pendulum.command(-0.5 * 9.81)
    positions = pendulum.run(0.5)
    assert pendulum.state("effort") == pytest.approx([-0.5 * 9.81])
    assert np.abs(positions).max() < 1e-6


def test_effort_of_zero_lets_the_joint_fall(bench, parts):
    pendulum = bench(parts.pendulum())
    pendulum.claim("effort")
    assert pendulum.run(0.5)[-1, 0] > 0.5


@pytest.mark.parametrize("interface", ["position", "velocity", "effort"])
def test_switching_modes_does_not_jerk_a_standing_joint(bench, parts, interface):
    pendulum = bench(parts.pendulum())
    pendulum.claim("velocity")
    pendulum.run(1.0)
    pendulum.release("velocity")
    pendulum.claim(interface)
    if interface == "effort":
        pendulum.command(pendulum.state("effort")[0])
    assert np.abs(pendulum.run(0.2)).max() < 1e-4


def test_position_takes_precedence_over_velocity(bench, parts):
    pendulum = bench(parts.pendulum())
    pendulum.hardware.perform_command_mode_switch(["j/velocity", "j/position"], [])
    pendulum.commands[:] = [0.4, 2.0, math.nan]
    assert pendulum.run(2.0)[-1] == pytest.approx([0.4], abs=1e-3)


def test_nan_is_ignored(bench, parts):
    arm = bench(parts.arm())
    arm.claim()
    arm.command(0.2, 0, 0, 0)
    arm.run(0.5)
    arm.command(math.nan, 0.3, math.nan, math.nan)
    positions = arm.run(1.5)
    assert positions[-1] == pytest.approx([0.2, 0.3, 0, 0], abs=1e-3)


@pytest.mark.parametrize(
    ("interface", "value", "sentence"),
    [
        ("position", 5.0, "position command 5 rad is beyond its limit of 3 rad"),
        ("position", -math.inf, "position command -inf rad is beyond its limit of -3 rad"),
        ("velocity", -4.0, "velocity command -4 rad/s is beyond its limit of -3 rad/s"),
        ("effort", 21.0, "effort command 21 N m is beyond its limit of 20 N m"),
    ],
)
def test_command_beyond_a_limit_is_explained(bench, parts, interface, value, sentence):
    pendulum = bench(parts.pendulum())
    pendulum.claim(interface)
    pendulum.command(value)
    pendulum.tick()
    [warning] = pendulum.hardware.take_warnings()
    assert warning.startswith(f"joint 'j': {sentence}")


@pytest.mark.parametrize("limit", ["", 'effort="2" velocity="0"', 'effort="0" velocity="1e12"'])
@pytest.mark.parametrize("speed", [-15.0, 60.0])
def test_a_wheel_without_a_velocity_limit_reaches_its_command(bench, parts, limit, speed):
    wheel = bench(parts.wheel(1.0, limit))
    wheel.claim("velocity")
    wheel.command(speed)
    wheel.run(2.0)
    assert wheel.state("velocity") == pytest.approx([speed], rel=1e-3)
    assert wheel.hardware.take_warnings() == []
    wheel.release("velocity")
    wheel.run(2.0)
    assert wheel.state("velocity") == pytest.approx([0.0], abs=1e-3)
    wheel.claim("position")
    start = wheel.state("position")[0]
    wheel.command(start + 9.0)
    way = wheel.run(1.0)[:, 0] - start
    assert 2.0 < way[-1] < 3.0 + 1e-6


@pytest.mark.parametrize("rate_hz", [100, 500, 1000])
def test_a_strong_drive_turns_a_light_free_wheel_steadily(bench, parts, rate_hz):
    """MuJoCo keeps the inertia of such a joint from when the model was made."""
    wheel = bench(parts.wheel(0.6, 'effort="50" velocity="3"'), rate_hz)
    wheel.claim("velocity")
    wheel.command(2.0)
    fastest = 0.0
    for _ in range(round(0.5 * rate_hz)):
        wheel.tick()
        fastest = max(fastest, wheel.state("velocity")[0])
    assert fastest < 2.2
    assert wheel.state("velocity") == pytest.approx([2.0], abs=1e-3)


def test_command_beyond_a_limit_is_clamped(bench, parts):
    pendulum = bench(parts.pendulum(limit='lower="-1" upper="1" effort="20" velocity="3"'))
    pendulum.claim()
    pendulum.command(1.5)
    assert pendulum.run(2.0)[-1] == pytest.approx([1.0], abs=1e-3)


def test_every_violation_of_a_limit_is_reported_once(bench, parts):
    pendulum = bench(parts.pendulum())
    pendulum.claim()
    told = []
    for command in (4.0, 4.5, 5.0, 1.0, 4.0, 4.1):
        pendulum.command(command)
        pendulum.tick()
        told.append(len(pendulum.hardware.take_warnings()))
    assert told == [1, 0, 0, 0, 1, 0]


def test_bounds_of_the_interface_narrow_the_joint_s(bench, parts):
    urdf = parts.pendulum().replace(
        '<command_interface name="position"/>',
        '<command_interface name="position"><param name="min">-0.2</param>'
        '<param name="max">0.2</param></command_interface>',
    )
    pendulum = bench(urdf)
    pendulum.claim()
    pendulum.command(1.0)
    assert pendulum.run(1.0)[-1] == pytest.approx([0.2], abs=1e-3)


def test_interface_that_does_not_exist_is_refused(bench, parts):
    hardware = bench(parts.pendulum()).hardware
    assert not hardware.prepare_command_mode_switch(["j/acceleration"], [])


def test_interfaces_that_cannot_be_simulated_are_left_out_and_reported(bench, parts, caplog):
    urdf = parts.pendulum().replace(
        "</ros2_control>",
        '<sensor name="imu"><state_interface name="orientation.x"/></sensor>'
        '<joint name="ghost"><state_interface name="position"/></joint></ros2_control>',
    )
    hardware = bench(urdf).hardware
    assert hardware.state_interfaces == ("j/position", "j/velocity", "j/effort")
    assert "left out: ghost/position, imu/orientation.x" in caplog.text


def test_two_components_share_one_simulation(bench, parts):
    block = parts.ros2_control(["b"]).replace('"sim"', '"other"')
    urdf = parts.robot(
        parts.link("base"),
        parts.link("l", 1, 0.1),
        parts.link("m", 1, 0.1),
        parts.joint("a", "base", "l", xyz="0 0 1"),
        parts.joint("b", "base", "m", xyz="1 0 1"),
        parts.ros2_control(["a"]),
        block,
    )
    first = bench(urdf)
    second = SimulatedHardware(first.simulation, parse_hardware_info(urdf)[1])
    commands = np.full(3, math.nan)
    second.bind(np.zeros(3), commands)
    assert second.on_activate()
    second.perform_command_mode_switch(["b/position"], [])
    commands[0] = 0.5
    first.claim()
    first.command(-0.5)
    for _ in range(200):
        assert second.write(0.0, 0.01) is HardwareReturn.OK
        first.tick()
    positions = first.simulation.data.qpos
    assert positions == pytest.approx([-0.5, 0.5], abs=1e-3)


def test_max_effort_limits_a_drive_as_long_as_it_is_claimed(bench, parts):
    commands = ("position", "max_effort")
    pendulum = bench(
        parts.pendulum().replace(parts.ros2_control(["j"]), parts.ros2_control(["j"], commands))
    )
    pendulum.claim("position")
    pendulum.claim("max_effort")
    assert math.isnan(pendulum.commanded[0])
    weight_nm = 0.5 * 9.81
    pendulum.command(1.2 * weight_nm)
    assert abs(pendulum.run(1.0)[-1, 0]) < 2e-3
    pendulum.command(0.5 * weight_nm)
    assert pendulum.run(0.5)[-1, 0] > 0.3
    assert pendulum.state("effort") == pytest.approx([-0.5 * weight_nm])
    pendulum.release("max_effort")
    pendulum.run(1.0)
    assert pendulum.state("velocity") == pytest.approx([0.0], abs=1e-3)


def test_slash_in_the_name_of_a_joint_is_part_of_it(bench, parts, caplog):
    urdf = parts.robot(
        parts.link("base"),
        parts.link("bob", 1.0),
        parts.joint("left/j", "base", "bob"),
        parts.ros2_control(["left/j"], ("position", "max_effort")),
    )
    assert bench(urdf).hardware.command_interfaces == ("left/j/position", "left/j/max_effort")
    assert "left out" not in caplog.text


def test_a_weakened_drive_still_stops_at_its_command(bench, parts):
    commands = ("position", "max_effort")
    pendulum = bench(
        parts.pendulum().replace(parts.ros2_control(["j"]), parts.ros2_control(["j"], commands))
    )
    pendulum.claim("max_effort")
    pendulum.command(6.0)
    pendulum.claim("position")
    pendulum.command(-1.0)
    way = pendulum.run(3.0)[:, 0]
    assert way[-1] == pytest.approx(-1.0, abs=2e-3)
    assert way.min() > -1.03
