"""What each gripper controller commands, claims and reports."""

from math import inf
from typing import Any

import pytest

from arm_control.controllers.controller import ControllerContext
from arm_control.controllers.gripper.controller import ParallelGripperController
from arm_control.errors import ControllerManagerError, ParameterError

POSITION = "position_controllers/GripperActionController"
EFFORT = "effort_controllers/GripperActionController"
PARALLEL = "parallel_gripper_action_controller/GripperActionController"


def test_position_commands_the_position_and_reports_the_goals_effort(make_rig):
    rig = make_rig(POSITION, max_effort=100.0)
    rig.goal(0.7, efforts=5.0)
    rig.tick()
    assert rig.commanded() == 0.7
    rig.place(0.7)
    rig.tick()
    assert rig.result.state.effort == 5.0


def test_position_keeps_its_command_after_deactivation(make_rig):
    rig = make_rig(POSITION)
    rig.goal(0.7)
    rig.tick()
    rig.switch("", "gripper")
    assert rig.commanded() == 0.7


@pytest.mark.parametrize(("of_goal", "limit"), [(5.0, 5.0), (0.0, 100.0)])
def test_position_limits_the_effort_where_hardware_can(make_rig, of_goal, limit):
    rig = make_rig(POSITION, max_effort=100.0, max_effort_interface="grip/most_effort")
    rig.goal(0.7, efforts=of_goal)
    rig.tick()
    assert rig.commanded() == 0.7
    assert rig.commanded("most_effort") == limit


def effort_rig(make_rig: Any, **parameters: Any) -> Any:
    gains = {f"gains.grip.{name}": value for name, value in {"p": 10.0, "d": 2.0}.items()}
    return make_rig(EFFORT, **{"max_effort": 100.0, **gains, **parameters})


def test_effort_follows_its_gains_and_reports_what_it_commands(make_rig):
    rig = effort_rig(make_rig)
    rig.place(0.2, velocity=0.5)
    rig.goal(0.7)
    rig.tick()
    assert rig.commanded("effort") == pytest.approx(10.0 * 0.5 - 2.0 * 0.5)
    rig.place(0.695)
    rig.tick()
    assert rig.result.state.effort == pytest.approx(10.0 * 0.005)


@pytest.mark.parametrize(
    ("of_goal", "of_controller", "limit"),
    [(1.5, 0.0, 1.5), (-1.5, 0.0, 1.5), (3.5, 2.5, 3.5), (0.0, 2.5, 0.0), (0.0, 0.0, 0.0)],
)
def test_effort_is_bounded_by_the_goal_and_by_nothing_else(make_rig, of_goal, of_controller, limit):
    rig = effort_rig(make_rig, max_effort=of_controller)
    rig.goal(0.5, efforts=of_goal)
    rig.tick()
    assert rig.commanded("effort") == pytest.approx(limit)
    rig.goal(-0.5, efforts=of_goal)
    rig.tick()
    assert rig.commanded("effort") == pytest.approx(-limit)


@pytest.mark.parametrize("bound", [0.0, 2.5])
def test_effort_is_limited_by_the_parameter(make_rig, bound):
    rig = effort_rig(make_rig, max_effort=bound)
    rig.place(0.5)
    rig.tick()
    assert rig.commanded("effort") == pytest.approx(-bound)
    rig.goal(1.0, efforts=4.0)
    rig.tick()
    assert rig.commanded("effort") == pytest.approx(4.0)
    rig.controller.cancel_goal("goal")
    rig.tick()
    rig.place(0.0)
    rig.tick()
    assert rig.commanded("effort") == pytest.approx(bound)


def test_a_goal_that_allows_no_effort_is_warned_of(make_rig, caplog):
    rig = effort_rig(make_rig)
    rig.goal(0.5, "first", efforts=1.0)
    rig.tick()
    assert "allows no effort" not in caplog.text
    rig.goal(0.5, efforts=0.0)
    rig.run(1.5)
    assert "allows no effort" in caplog.text
    assert rig.result.stalled


def test_the_integral_is_clamped_and_forgotten_at_activation(make_rig):
    gains = {"gains.grip.i": 10.0, "gains.grip.i_clamp": 0.3}
    rig = make_rig(EFFORT, max_effort=100.0, **gains)
    rig.goal(1.0)
    rig.run(0.5)
    assert rig.commanded("effort") == pytest.approx(0.3)
    rig.switch("", "gripper")
    rig.switch("gripper")
    rig.tick()
    assert rig.commanded("effort") == 0.0


def test_effort_is_0_after_deactivation(make_rig):
    rig = effort_rig(make_rig)
    rig.goal(0.7)
    rig.tick()
    rig.switch("", "gripper")
    assert rig.commanded("effort") == 0.0


def test_gains_change_while_it_runs(make_rig):
    rig = effort_rig(make_rig)
    rig.goal(0.5)
    rig.set(**{"gains.grip.p": 4.0})
    rig.tick()
    assert rig.commanded("effort") == pytest.approx(2.0)


def parallel_rig(make_rig: Any, **parameters: Any) -> Any:
    return make_rig(
        PARALLEL,
        max_effort_interface="grip/most_effort",
        max_velocity_interface="grip/most_velocity",
        **parameters,
    )


def test_parallel_hands_limits_to_the_hardware(make_rig):
    rig = parallel_rig(make_rig)
    rig.goal(0.7, efforts=5.0, velocities=0.3)
    rig.tick()
    commands = [rig.commanded(kind) for kind in ("position", "most_effort", "most_velocity")]
    assert commands == [0.7, 5.0, 0.3]


def test_parallel_takes_its_parameters_where_the_goal_names_no_limits(make_rig):
    rig = parallel_rig(make_rig)
    rig.goal(0.0)
    rig.tick()
    commands = [rig.commanded(kind) for kind in ("position", "most_effort", "most_velocity")]
    assert commands == [0.0, 10.0, 0.1]
    assert rig.result.state.effort == 10.0


def test_parallel_claims_the_interfaces_in_its_parameters(make_rig):
    def claimed(rig: Any) -> set[str]:
        return set(rig.manager.list_controllers()[0].claimed_interfaces)

    assert claimed(make_rig(PARALLEL)) == {"grip/position"}
    assert claimed(parallel_rig(make_rig)) == {
        "grip/position",
        "grip/most_effort",
        "grip/most_velocity",
    }


def test_parallel_reads_its_states_whatever_their_order(make_rig):
    rig = make_rig(PARALLEL, state_interfaces=["temperature", "velocity", "position"])
    rig.place(0.25, velocity=0.5)
    rig.goal(0.25)
    rig.tick()
    assert (rig.result.state.position, rig.result.state.velocity) == (0.25, 0.5)


def test_parallel_needs_position_and_velocity(make_rig):
    with pytest.raises(ControllerManagerError, match=r"\[position\]; it lacks 'velocity'"):
        make_rig(PARALLEL, state_interfaces=["position"])


@pytest.mark.parametrize("type_name", [POSITION, EFFORT])
def test_the_older_types_say_at_load_which_is_newer_without_a_warning(make_rig, caplog, type_name):
    caplog.set_level("INFO")
    make_rig(type_name, activate=False)
    (said,) = (r for r in caplog.records if r.getMessage().startswith(f"{type_name} serves"))
    assert "newer type is parallel_gripper_action_controller" in said.getMessage()
    assert said.levelname == "INFO"


def test_the_newer_type_logs_nothing(caplog):
    ParallelGripperController(ControllerContext("gripper", 100))
    assert not caplog.messages


@pytest.mark.parametrize("type_name", [POSITION, EFFORT, PARALLEL])
def test_an_empty_joint_is_refused(make_rig, type_name):
    with pytest.raises(ControllerManagerError, match="'joint' parameter was empty"):
        make_rig(type_name, joint="")


def test_a_value_out_of_range_is_refused_and_the_old_ones_stay(make_rig):
    rig = make_rig(goal_tolerance=0.02)
    with pytest.raises(ParameterError, match="'goal_tolerance' must be at least 0, but is -1"):
        rig.set(goal_tolerance=-1.0)
    assert rig.controller.parameters.goal_tolerance == 0.02


def test_a_bound_of_the_integral_below_zero_is_refused(make_rig):
    says = r"'gains\.grip\.i_clamp' must be at least 0, but is -5"
    with pytest.raises(ControllerManagerError, match=says):
        effort_rig(make_rig, **{"gains.grip.i_clamp": -5.0})
    rig = effort_rig(make_rig, **{"gains.grip.i_clamp": inf})
    with pytest.raises(ParameterError, match=says):
        rig.set(**{"gains.grip.i_clamp": -5.0})
    assert rig.controller.parameters.gains.i_clamp == inf
