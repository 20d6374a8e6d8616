"""A reset returns a run to its start in one tick; nothing is deactivated, nothing snaps back."""

import numpy as np
import pytest

from arm_control.controllers.goals import GoalOutcome
from arm_control.errors import ControllerError, StateError

FORWARD = (
    "position_controllers/JointGroupPositionController",
    {"joints": ["j0", "j1", "j2", "j3"]},
)


def active(robot) -> set[str]:
    return {c.name for c in robot.manager.list_controllers() if c.state.label == "active"}


def positions(robot) -> np.ndarray:
    return robot.simulation.data.qpos[:4].copy()


@pytest.mark.parametrize("clock", [True, False])
def test_the_arm_stands_at_its_start_and_stays_there(arm, clock):
    robot = arm()
    robot.move(1.0, 0.6, -0.5, 0.4)
    robot.run(80)
    before = active(robot)
    robot.state.reset(clock)
    assert positions(robot) == pytest.approx(0.0, abs=1e-12)
    assert robot.simulation.time_s == pytest.approx(0.0 if clock else 0.8)
    assert active(robot) == before
    robot.run(100)
    assert positions(robot) == pytest.approx(0.0, abs=2e-3)


def test_goals_are_aborted_with_the_reason(mycobot):
    robot = mycobot()
    robot.move(0.6, -1.2, -0.4, 0.2, 0.0, 0.3, seconds=5.0)
    robot.grip(-0.4)
    robot.run(5)
    robot.state.reset(True)
    for goal in (b"goal", b"grip"):
        result = robot.results.by_goal[goal]
        assert result.outcome is GoalOutcome.ABORTED
        assert result.message == "Goal aborted: the simulation was reset."


def test_a_goal_that_waits_for_the_next_tick_is_aborted_as_well(arm):
    robot = arm()
    robot.run(1)
    robot.move(1.0, 0.6, -0.5, 0.4)
    robot.state.reset(True)
    assert robot.results.by_goal[b"goal"].outcome is GoalOutcome.ABORTED


def test_a_goal_after_a_reset_succeeds(arm):
    robot = arm()
    robot.move(1.0, 0.6, -0.5, 0.4)
    robot.run(30)
    robot.state.reset(True)
    robot.move(0.5, 0.2, 0.1, 0.0, goal=b"second")
    robot.run(200)
    assert robot.results.by_goal[b"second"].outcome is GoalOutcome.SUCCEEDED


def test_a_forwarded_command_is_forgotten(arm):
    robot = arm(forward=FORWARD)
    robot.controllers["forward"].offer([1.0, 0.6, -0.5, 0.4])
    robot.run(100)
    robot.state.reset(True)
    robot.run(100)
    assert positions(robot) == pytest.approx(0.0, abs=2e-3)


def test_runs_after_two_resets_are_equal_to_the_bit(arm):
    robot = arm("pick_and_place_demo")

    def run() -> list[bytes]:
        robot.state.reset(True)
        robot.results.readings.clear()
        robot.move(0.5, 0.2, 0.1, 0.0)
        return [*robot.run(150), *(reading for _, reading in robot.results.readings)]

    robot.move(1.0, 0.6, -0.5, 0.4)
    robot.run(77)
    first = run()
    robot.move(-1.0, 0.0, 0.5, 0.0, goal=b"another")
    robot.run(33)
    assert run() == first


def test_the_states_are_published_at_once(arm):
    robot = arm()
    robot.move(1.0, 0.6, -0.5, 0.4)
    robot.run(50)
    robot.results.readings.clear()
    robot.state.reset(True)
    assert robot.results.readings, "the joint states"
    assert robot.results.readings[-1][0] == 0.0


def test_only_the_clock_is_set_and_a_goal_goes_on(arm):
    robot = arm()
    robot.move(1.0, 0.6, -0.5, 0.4)
    robot.run(50)
    there = positions(robot)
    robot.state.set_clock(0.0)
    assert robot.simulation.time_s == 0.0
    assert positions(robot) == pytest.approx(there)
    robot.run(100)
    assert robot.simulation.time_s == pytest.approx(1.0)
    assert robot.results.by_goal[b"goal"].outcome is GoalOutcome.SUCCEEDED


def test_an_integral_is_cleared(robot, parts):
    pid = (
        "pid_controller/PidController",
        {
            "dof_names": ["j"],
            "command_interface": "effort",
            "reference_and_state_interfaces": ["position"],
            "gains.j.p": 10.0,
            "gains.j.i": 50.0,
            "gains.j.d": 1.0,
            "gains.j.save_i_term": True,
        },
    )
    held = robot(parts.pendulum(), {"pid": pid})
    held.controllers["pid"].offer([], [0.3])
    held.run(200)
    assert abs(held.controllers["pid"].save_state()["_pid"][0]) > 0.1
    held.state.reset(True)
    assert held.controllers["pid"].save_state()["_pid"][0] == 0.0


def test_a_controller_that_cannot_be_reset_is_named_and_the_others_are(arm, caplog):
    robot = arm(forward=FORWARD)
    robot.controllers["forward"].offer([1.0, 0.6, -0.5, 0.4])
    robot.run(50)

    def refuse() -> None:
        raise ControllerError("it is stuck")

    robot.controllers["forward"].on_activate = refuse
    with pytest.raises(StateError, match="controller 'forward': it is stuck"):
        robot.state.reset(True)
    assert robot.simulation.time_s == 0.0
