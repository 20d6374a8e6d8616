"""Trajectory time that runs faster, slower, or not at all."""

import numpy as np
import pytest

MOVE = [(1.0, [1.0, 2.0, 3.0])]
BRAKES = {
    f"constraints__j{i}__max_deceleration_on_cancel": value
    for i, value in enumerate((1.0, 2.0, 4.0))
}


def test_setting_scaling_factor_works_correctly(make_rig):
    rig = make_rig()

    assert rig.controller.request_speed_scaling(0.5)
    rig.tick()
    assert rig.sink.state.speed_scaling == 0.5
    assert rig.controller.request_speed_scaling(2.0)
    rig.tick()
    assert rig.sink.state.speed_scaling == 2.0


@pytest.mark.parametrize("factor", [-0.1, np.nan, np.inf, 1e300])
def test_an_invalid_factor_is_ignored(make_rig, factor, caplog):
    rig = make_rig()

    assert not rig.controller.request_speed_scaling(factor)
    rig.tick()
    assert rig.sink.state.speed_scaling == 1.0
    assert "Ignoring input!" in caplog.text


def test_a_factor_of_zero_holds_the_command(make_rig):
    rig = make_rig()
    rig.trajectory(MOVE)
    rig.run(0.5)
    rig.controller.request_speed_scaling(0.0)
    rig.tick()
    paused = rig.commanded()
    rig.run(5.0)
    assert rig.commanded().tolist() == paused.tolist()

    rig.controller.request_speed_scaling(1.0)
    rig.run(0.52)
    assert rig.measured().tolist() == [1.0, 2.0, 3.0]


def test_a_change_makes_no_step(make_rig):
    rig = make_rig()
    rig.trajectory([(1.0, [1.0, 1.0, 1.0])])
    commanded = []
    for factor in (1.0, 0.5, 0.0, 2.0, 0.1, 1.0):
        rig.controller.request_speed_scaling(factor)
        rig.tick()
        commanded.append(rig.commanded()[0])

    assert np.diff(commanded) == pytest.approx([0.005, 0.0, 0.02, 0.001, 0.01])


def test_a_goal_whose_speed_is_scaled_to_0_does_not_time_out(make_rig):
    rig = make_rig(constraints__j0__goal=0.1, constraints__goal_time=0.1)
    rig.goal(MOVE)
    rig.run(0.5)
    rig.controller.request_speed_scaling(0.0)
    rig.run(10.0)

    assert rig.result is None


def test_braking_is_not_scaled(make_rig, robot_description):
    rig = make_rig(
        constraints__decelerate_on_cancel=True,
        robot_description=robot_description(),
        speed_scaling__initial_scaling_factor=0.5,
        **BRAKES,
    )
    rig.goal([(10.0, [1.0, 2.0, 3.0])])
    rig.run(0.5)
    rig.place([1.0, 0.0, 0.0], "velocity")
    start = rig.measured()
    rig.controller.cancel_goal("goal")
    rig.tick()
    rig.run(1.0)

    assert rig.commanded() == pytest.approx(start + np.array([0.5, 0.0, 0.0]))


def test_hardware_can_tell_the_factor(make_rig):
    rig = make_rig(speed_scaling__state_interface="speed/factor")
    rig.moves = False
    rig.set_state("speed/factor", 0.25)
    rig.tick()
    assert rig.sink.state.speed_scaling == 0.25

    rig.set_state("speed/factor", np.nan)
    rig.tick()
    assert rig.sink.state.speed_scaling == 0.25, "hardware that is starting says nothing"


def test_a_factor_can_be_requested_from_hardware(make_rig):
    rig = make_rig(speed_scaling__command_interface="speed/factor")
    rig.controller.request_speed_scaling(0.25)
    rig.tick()

    assert rig.command("speed/factor") == 0.25
    assert rig.commanded().tolist() == [0.0, 0.0, 0.0]


def test_a_wish_that_hardware_will_overwrite_is_warned_of(make_rig, caplog):
    rig = make_rig(speed_scaling__state_interface="speed/factor")
    rig.controller.request_speed_scaling(0.25)

    assert "speed_scaling.command_interface" in caplog.text


def test_deactivation_leaves_the_hardwares_factor(make_rig):
    rig = make_rig(
        commands=("position", "velocity"), speed_scaling__command_interface="speed/factor"
    )
    rig.tick()
    rig.deactivate()

    assert rig.command("speed/factor") == 1.0


@pytest.mark.parametrize(
    ("commands", "takes"), [(("position",), True), (("position", "velocity"), False)]
)
def test_is_for_positions_only(make_rig, commands, takes):
    assert make_rig(commands=commands).controller.takes_speed_scaling is takes
