"""A run goes on bit for bit from a saved state: physics, drives, controllers, noise, clock."""

import numpy as np
import pytest

from arm_control import (
    Controller,
    ControllerContext,
    InterfaceConfiguration,
    NoParameters,
    ReturnType,
)
from arm_control.controllers.goals import GoalOutcome
from arm_control.errors import StateError

FORWARD = (
    "position_controllers/JointGroupPositionController",
    {"joints": ["j0", "j1", "j2", "j3"]},
)


def published(robot) -> tuple[list, list]:
    """Return what was published since the last call."""
    taken = list(robot.results.readings), list(robot.results.states)
    robot.results.readings.clear()
    robot.results.states.clear()
    return taken


@pytest.mark.parametrize("ticks_before", [1, 37, 99, 150])
def test_an_arm_with_a_trajectory_goes_on_with_the_same_bits(arm, ticks_before):
    robot = arm()
    robot.move(1.0, 0.6, -0.5, 0.4)
    robot.run(ticks_before)
    saved = robot.state.save()
    published(robot)
    first = robot.run(200), robot.state.save(), published(robot)
    robot.restore(saved)
    assert robot.state.save() == saved
    shown, _ = published(robot)
    assert [time_s for time_s, _ in shown] == [pytest.approx(ticks_before / 100)]
    second = robot.run(200), robot.state.save(), published(robot)
    assert first == second
    assert robot.results.by_goal[b"goal"].outcome is GoalOutcome.SUCCEEDED


def test_a_state_is_restored_in_another_process_as_well(arm):
    robot, other = arm(), arm()
    robot.move(1.0, 0.6, -0.5, 0.4)
    robot.run(50)
    saved = robot.state.save()
    other.run(13)
    other.restore(saved)
    assert robot.run(150) == other.run(150)


@pytest.mark.parametrize("ticks_before", [560, 600, 900])
def test_a_grasp_with_contacts_goes_on_with_the_same_bits(mycobot, pick, ticks_before):
    robot = mycobot()
    pick(robot, ticks_before)
    saved = robot.state.save()
    assert robot.simulation.data.ncon > 0, "the fingers touch the object"
    first = robot.run(150), robot.state.save()
    robot.restore(saved)
    assert (robot.run(150), robot.state.save()) == first


def test_things_that_sleep_and_wake_go_on_with_the_same_bits(arm):
    robot = arm("pick_and_place_demo")
    robot.run(300)
    saved = robot.state.save()
    assert robot.simulation.data.ntree_awake < robot.simulation.model.ntree
    first = robot.run(100)
    robot.simulation.place("red_cylinder::joint", np.array([0.3, 0.3, 1, 1, 0, 0, 0]), np.zeros(6))
    robot.run(100)
    robot.restore(saved)
    assert robot.run(100) == first


def test_a_run_that_has_gone_another_way_is_brought_back(arm):
    robot = arm("pick_and_place_demo")
    robot.move(1.0, 0.6, -0.5, 0.4)
    robot.run(30)
    saved = robot.state.save()
    first = robot.run(120)
    robot.move(-1.0, 0.0, 0.5, 0.0, goal=b"another")
    robot.run(80)
    robot.restore(saved)
    assert robot.run(120) == first
    assert robot.results.by_goal[b"another"].message == (
        "Goal aborted: the simulation was restored to a snapshot without this goal."
    )


def test_two_hundred_branches_from_one_point_are_equal(arm):
    robot = arm()
    robot.move(1.0, 0.6, -0.5, 0.4)
    robot.run(50)
    saved = robot.state.save()
    first = robot.run(3)
    for _ in range(200):
        robot.restore(saved)
        assert robot.run(3) == first


def test_controllers_are_active_as_they_were_then(arm):
    robot = arm(forward=FORWARD)
    robot.switch(activate=("arm",), deactivate=("forward",))
    robot.run(10)
    saved = robot.state.save()
    first = robot.run(30)
    robot.switch(activate=("forward",), deactivate=("arm",))
    assert robot.controllers["forward"].offer([0.5, 0.5, 0.5, 0.5])
    robot.run(60)
    robot.restore(saved)
    assert active(robot) == {"joint_states", "arm"}
    assert robot.run(30) == first


def active(robot) -> set[str]:
    return {c.name for c in robot.manager.list_controllers() if c.state.label == "active"}


def test_the_same_commands_lead_to_the_same_bits_again(arm):
    robot = arm(forward=FORWARD)
    saved = robot.state.save()

    def branch() -> list[bytes]:
        digests = []
        for tick in range(60):
            robot.controllers["forward"].offer(np.sin([tick * 0.1, 1, 2, 3]))
            digests += robot.run(1)
        return digests

    first = branch()
    robot.restore(saved)
    assert branch() == first


class Talker(Controller[NoParameters]):
    """A controller of a user who knows nothing of snapshots."""

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.sum = 0.0
        self.seen: list[float] = []
        self.line = None

    def command_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.none()

    def state_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.individual(["j0/position"])

    def update(self, time_s: float, period_s: float) -> ReturnType:
        self.sum += self.states.read()[0] * period_s
        self.seen = [*self.seen[-3:], time_s]
        return ReturnType.OK


def test_the_attributes_of_a_users_controller_are_its_state(arm):
    robot = arm()
    talker = Talker(ControllerContext("talker", 100))
    robot.add(talker, "mine/Talker", NoParameters())
    robot.move(1.0, 0.6, -0.5, 0.4)
    robot.run(50)
    saved, attributes = robot.state.save(), (talker.sum, list(talker.seen))
    first = robot.run(20)
    assert (talker.sum, talker.seen) != attributes
    robot.restore(saved)
    assert (talker.sum, talker.seen) == attributes
    assert robot.run(20) == first


def test_a_controller_that_cannot_be_saved_is_named_with_its_attribute(arm):
    robot = arm()
    talker = Talker(ControllerContext("talker", 100))
    robot.add(talker, "mine/Talker", NoParameters())
    talker.line = [open]  # type: ignore[assignment]
    with pytest.raises(
        StateError,
        match=r"controller 'talker' cannot be saved: its attribute "
        r"line\[0\] is a builtins.builtin_function_or_method; define",
    ):
        robot.state.save()


def test_a_state_that_does_not_fit_is_refused_with_what_differs(arm, mycobot):
    robot = arm(forward=FORWARD)
    saved = robot.state.save()
    with pytest.raises(
        StateError, match="has controller 'forward', which is not loaded; loaded: joint_states, arm"
    ):
        arm().state.check(saved)
    with pytest.raises(StateError, match="hardware components"):
        mycobot().state.check(saved)
    with pytest.raises(StateError, match="damaged near byte"):
        robot.state.check(saved[:-5])


def test_the_fingerprint_names_what_differs(arm):
    robot, other = arm(), arm()
    for each in (robot, other):
        each.move(1.0, 0.6, -0.5, 0.4)
        each.run(20)
    assert dict(robot.state.fingerprint()) == dict(other.state.fingerprint())
    other.simulation.data.qvel[0] += 1e-12
    before, after = dict(robot.state.fingerprint()), dict(other.state.fingerprint())
    assert [name for name in before if before[name] != after[name]] == ["physics"]
    assert robot.state.digest() != other.state.digest()
