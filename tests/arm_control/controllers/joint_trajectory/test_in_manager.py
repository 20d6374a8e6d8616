"""The controller among others, under the controller manager."""

from dataclasses import replace
from typing import Any

import pytest

from arm_control.controllers.controller import ControllerContext
from arm_control.controllers.forward_command.controller import (
    JointGroupPositionController,
    PositionGroupParameters,
)
from arm_control.controllers.joint_trajectory.controller import JointTrajectoryController
from arm_control.controllers.joint_trajectory.goals import GoalRequest, GoalResult
from arm_control.controllers.joint_trajectory.parameters import JointTrajectoryParameters
from arm_control.controllers.joint_trajectory.trajectory import TrajectoryPoint, TrajectoryRequest
from arm_control.errors import ControllerManagerError
from arm_control.parameters import build_parameters

JOINTS = ("j0", "j1", "j2", "j3")
PARAMETERS = build_parameters(
    JointTrajectoryParameters,
    {
        "joints": JOINTS,
        "command_interfaces": ["position"],
        "state_interfaces": ["position", "velocity"],
    },
)


class Results:
    """A sink for results alone."""

    def __init__(self) -> None:
        self.results: list[GoalResult] = []

    def open(self, layout: object) -> None:
        pass

    def publish_state(self, state: object) -> None:
        pass

    def publish_feedback(self, goal_id: object, feedback: object) -> None:
        pass

    def finish_goal(self, goal_id: object, result: GoalResult) -> None:
        self.results.append(result)


@pytest.fixture
def sink() -> Results:
    return Results()


@pytest.fixture
def controller(bench, sink) -> JointTrajectoryController:
    controller = JointTrajectoryController(ControllerContext("jtc", 100))
    controller.sink = sink
    bench.manager.load_controller(controller, "test")
    return controller


def go(controller: JointTrajectoryController, time_s: float, *positions: float) -> None:
    goal = GoalRequest(1, TrajectoryRequest(JOINTS, [TrajectoryPoint(time_s, positions)]))
    assert controller.submit_goal(goal) is None


def positions(bench: Any) -> list[float]:
    names = bench.hardware.state_interfaces
    return [bench.hardware.states[names.index(f"{joint}/position")] for joint in JOINTS]


def test_follows_a_goal(bench, controller, sink):
    bench.manager.configure_controller("jtc", PARAMETERS)
    bench.switch("jtc")
    go(controller, 0.5, 1.0, 2.0, 3.0, 4.0)
    bench.tick(51)

    assert positions(bench) == [1.0, 2.0, 3.0, 4.0]
    assert [result.message for result in sink.results] == ["Goal successfully reached!"]


def test_runs_at_its_own_rate(bench, controller):
    bench.manager.configure_controller("jtc", PARAMETERS, 25)
    bench.switch("jtc")
    go(controller, 0.4, 1.0, 2.0, 3.0, 4.0)
    bench.tick(45)

    assert positions(bench) == [1.0, 2.0, 3.0, 4.0]


def test_takes_over_from_another_controller_without_a_jump(bench, controller):
    forward = JointGroupPositionController(ControllerContext("forward", 100))
    bench.manager.load_controller(forward, "test")
    bench.manager.configure_controller("forward", PositionGroupParameters(JOINTS))
    bench.manager.configure_controller("jtc", PARAMETERS)
    bench.switch("forward")
    forward.offer([0.1, 0.2, 0.3, 0.4])
    bench.tick()
    bench.switch("jtc", "forward")
    bench.tick(10)

    assert positions(bench) == [0.1, 0.2, 0.3, 0.4]


def test_hands_over_in_the_middle_of_a_goal(bench, controller, sink):
    forward = JointGroupPositionController(ControllerContext("forward", 100))
    bench.manager.load_controller(forward, "test")
    bench.manager.configure_controller("forward", PositionGroupParameters(JOINTS))
    bench.manager.configure_controller("jtc", PARAMETERS)
    bench.switch("jtc")
    go(controller, 1.0, 1.0, 1.0, 1.0, 1.0)
    bench.tick(51)
    bench.switch("forward", "jtc")
    bench.tick(10)

    assert [result.message for result in sink.results] == [
        "Current goal cancelled during deactivate transition."
    ]
    assert positions(bench) == pytest.approx([0.51] * 4)


@pytest.mark.parametrize(
    "parameters",
    [replace(PARAMETERS, state_interfaces=()), replace(PARAMETERS, action_monitor_rate=0.0)],
)
def test_says_why_it_is_not_configured(bench, controller, parameters, caplog):
    with pytest.raises(ControllerManagerError, match="parameter"):
        bench.manager.configure_controller("jtc", parameters)

    assert "Traceback" not in caplog.text


def test_can_be_configured_again(bench, controller):
    bench.manager.configure_controller("jtc", PARAMETERS)
    bench.manager.configure_controller("jtc", replace(PARAMETERS, joints=("j0",)))
    bench.switch("jtc")
    bench.tick()

    (status,) = bench.manager.list_controllers()
    assert status.claimed_interfaces == ("j0/position",)
