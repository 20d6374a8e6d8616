"""A gripper controller under a manager on fake hardware, ticked by hand."""

import logging
from collections.abc import Callable
from typing import Any

import pytest
from manager_bench import PERIOD_S, ManagerBench

from arm_control import ControllerContext
from arm_control.controllers.gripper.controller import GripperController
from arm_control.controllers.gripper.goals import GripperRequest, GripperResult
from arm_control.manager.registry import controller_class
from arm_control.testing import fake_hardware

POSITION = "position_controllers/GripperActionController"
EFFORT = "effort_controllers/GripperActionController"
PARALLEL = "parallel_gripper_action_controller/GripperActionController"


class RecordingSink:
    """Records all calls."""

    def __init__(self) -> None:
        self.openings = 0
        self.results: dict[object, GripperResult] = {}

    def open(self) -> None:
        self.openings += 1

    def finish_goal(self, goal_id: object, result: GripperResult) -> None:
        assert goal_id not in self.results, "a goal ends once"
        self.results[goal_id] = result


class Rig(ManagerBench):
    """An active controller of the joint 'grip', whose state the test sets.

    Attributes:
        controller: the controller.
        sink: what it said.
    """

    def __init__(self, type_name: str, parameters: dict[str, Any]) -> None:
        super().__init__(
            fake_hardware(
                ["grip"],
                command_interfaces=("position", "effort", "most_effort", "most_velocity"),
                state_interfaces=("position", "velocity", "temperature"),
            )
        )
        self.place(0.0)
        self.controller: GripperController[Any] = controller_class(type_name)(
            ControllerContext("gripper", 100)
        )
        self.sink = RecordingSink()
        self.controller.sink = self.sink
        self.values = {"joint": "grip", **parameters}
        self.manager.load_controller(self.controller, type_name)
        self.manager.configure_controller("gripper", self.controller.build_parameters(self.values))

    def set(self, **parameters: Any) -> None:
        """Change parameters while the controller runs."""
        self.values.update(parameters)
        self.controller.update_parameters(self.controller.build_parameters(self.values))

    def place(self, position: float, velocity: float = 0.0) -> None:
        """Put the joint somewhere, moving or not; it stays so whatever is commanded."""
        self.position, self.velocity = position, velocity
        self.move(PERIOD_S)

    def run(self, seconds: float) -> None:
        self.tick(round(seconds / PERIOD_S))

    def goal(self, position: float, goal_id: object = "goal", **limits: float) -> None:
        """Send a goal that must be taken."""
        request = GripperRequest(
            goal_id, [position], **{name: [value] for name, value in limits.items()}
        )
        assert self.controller.check_goal(request) == ""
        assert self.controller.submit_goal(request) is None

    @property
    def result(self) -> GripperResult | None:
        return self.sink.results.get("goal")

    def commanded(self, kind: str = "position") -> float:
        return float(self.hardware.commands[self.hardware.command_interfaces.index(f"grip/{kind}")])

    def move(self, period_s: float) -> None:
        self.hardware.states[:2] = self.position, self.velocity


@pytest.fixture
def make_rig() -> Callable[..., Rig]:
    """Make a rig of a type; keywords are parameters of the controller."""

    def make(type_name: str = POSITION, *, activate: bool = True, **parameters: Any) -> Rig:
        rig = Rig(type_name, parameters)
        if activate:
            rig.switch("gripper")
        return rig

    return make


@pytest.fixture(params=[POSITION, EFFORT, PARALLEL])
def rig(request: pytest.FixtureRequest, make_rig: Callable[..., Rig]) -> Rig:
    """Return a rig of each type, one after the other, all with the same parameters."""
    return make_rig(request.param, goal_tolerance=0.01, stall_timeout=0.5, max_effort=3.0)


@pytest.fixture(autouse=True)
def _all_levels(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO)
