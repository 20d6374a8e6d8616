"""A controller on fake hardware, ticked by hand."""

import logging
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

from arm_control.controllers.controller import ControllerContext
from arm_control.controllers.joint_trajectory.controller import JointTrajectoryController
from arm_control.controllers.joint_trajectory.goals import GoalRequest, GoalResult
from arm_control.controllers.joint_trajectory.state import ControllerState, Feedback, StateLayout
from arm_control.controllers.joint_trajectory.trajectory import TrajectoryPoint, TrajectoryRequest
from arm_control.controllers.loaned_interfaces import LoanedInterfaces
from arm_control.testing import fake_hardware

JOINTS = ("j0", "j1", "j2")
RATE_HZ = 100

INTERFACES = [
    (("position",), ("position",)),
    (("position",), ("position", "velocity")),
    (("position",), ("position", "velocity", "acceleration")),
    (("position", "velocity"), ("position",)),
    (("position", "velocity"), ("position", "velocity")),
    (("position", "velocity"), ("velocity", "position", "acceleration")),
    (("velocity", "position", "acceleration"), ("position",)),
    (("position", "velocity", "acceleration"), ("position", "velocity")),
    (("position", "velocity", "acceleration"), ("position", "velocity", "acceleration")),
    (("position", "effort"), ("position", "velocity")),
    (("velocity",), ("position", "velocity")),
    (("velocity",), ("position", "velocity", "acceleration")),
    (("effort",), ("position", "velocity")),
    (("effort",), ("position", "velocity", "acceleration")),
]
"""Command interfaces, and state interfaces that go with them."""

Point = tuple[Any, ...]
"""(time, positions), then velocities, accelerations and efforts as far as they are given."""


def trajectory_request(
    points: Sequence[Point], joints: Sequence[str] = JOINTS, stamp_s: float = 0.0
) -> TrajectoryRequest:
    return TrajectoryRequest(joints, [TrajectoryPoint(*point) for point in points], stamp_s)


class RecordingSink:
    """Records all calls."""

    def __init__(self) -> None:
        self.layout: StateLayout | None = None
        self.states: list[np.ndarray] = []
        self.feedback: list[tuple[object, Feedback]] = []
        self.results: dict[object, GoalResult] = {}

    def open(self, layout: StateLayout) -> None:
        self.layout = layout

    def publish_state(self, state: ControllerState) -> None:
        self.state = state
        self.states.append(state.values.copy())

    def publish_feedback(self, goal_id: object, feedback: Feedback) -> None:
        self.feedback.append((goal_id, feedback))

    def finish_goal(self, goal_id: object, result: GoalResult) -> None:
        assert goal_id not in self.results, "a goal ends once"
        self.results[goal_id] = result


class Rig:
    """An active controller on hardware that follows its commands at once.

    Attributes:
        controller: the controller.
        sink: what it said.
        time_s: of the last tick.
        moves: whether the hardware follows at all.
    """

    period_s = 1.0 / RATE_HZ

    def __init__(
        self,
        *,
        commands: Sequence[str] = ("position",),
        states: Sequence[str] = ("position", "velocity"),
        positions: Sequence[float] = (0.0, 0.0, 0.0),
        robot_description: str = "",
        parameters: dict[str, Any],
        activate: bool = True,
    ) -> None:
        self.controller = JointTrajectoryController(
            ControllerContext("jtc", RATE_HZ, robot_description)
        )
        self.sink = RecordingSink()
        self.controller.sink = self.sink
        self.time_s = 10.0
        self.moves = True
        extra = [
            name.split("/")
            for key, name in parameters.items()
            if key.startswith("speed_scaling.") and key.endswith("_interface")
        ]
        self._values = {
            "joints": JOINTS,
            "command_interfaces": tuple(commands),
            "state_interfaces": tuple(states),
        }
        self._values.update(parameters)
        self.controller.on_configure(self.controller.build_parameters(self._values))
        self.hardware = fake_hardware(
            [*JOINTS, *{part for part, _ in extra}],
            command_interfaces=[*commands, *{kind for _, kind in extra}],
            state_interfaces=[*states, *{kind for _, kind in extra}],
            initial_positions=dict(zip(JOINTS, positions, strict=True)),
        )
        self._states = np.zeros(len(self.hardware.state_interfaces))
        self._commands = np.full(len(self.hardware.command_interfaces), np.nan)
        self.hardware.bind(self._states, self._commands)
        self.hardware.on_configure()
        if activate:
            self.activate()

    def activate(self) -> None:
        commands = self.controller.command_interface_configuration().names
        states = self.controller.state_interface_configuration().names
        self.controller.assign_interfaces(
            LoanedInterfaces(commands, self._commands, self._where("command", commands)),
            LoanedInterfaces(states, self._states, self._where("state", states)),
        )
        self.controller.on_activate()

    def deactivate(self) -> None:
        self.controller.on_deactivate()
        self.controller.release_interfaces()

    def set(self, **parameters: Any) -> None:
        """Change parameters while the controller runs; '__' stands for a dot."""
        self._values.update({name.replace("__", "."): v for name, v in parameters.items()})
        self.controller.update_parameters(self.controller.build_parameters(self._values))

    def tick(self, count: int = 1) -> None:
        for _ in range(count):
            self.time_s = round(self.time_s + self.period_s, 9)
            self.controller.update(self.time_s, self.period_s)
            if self.moves:
                self.hardware.write(self.time_s, self.period_s)

    def run(self, seconds: float) -> None:
        self.tick(round(seconds * RATE_HZ))

    def trajectory(self, points: Sequence[Point], **options: Any) -> None:
        """Send a trajectory without a goal."""
        refusal = self.controller.submit_trajectory(trajectory_request(points, **options))
        assert refusal is None, refusal

    def goal(self, points: Sequence[Point], goal_id: object = "goal", **options: Any) -> None:
        """Send a goal that must be taken; see `GoalRequest` for the options."""
        trajectory = trajectory_request(
            points, options.pop("joints", JOINTS), options.pop("stamp_s", 0.0)
        )
        assert self.controller.check_goal(trajectory) is None
        assert self.controller.submit_goal(GoalRequest(goal_id, trajectory, **options)) is None

    @property
    def result(self) -> GoalResult | None:
        return self.sink.results.get("goal")

    def commanded(self, kind: str = "position") -> np.ndarray:
        return self._of(self._commands, self.hardware.command_interfaces, kind)

    def measured(self, kind: str = "position") -> np.ndarray:
        return self._of(self._states, self.hardware.state_interfaces, kind)

    def place(self, values: Sequence[float], kind: str = "position") -> None:
        """Put the joints somewhere."""
        for joint, value in zip(JOINTS, values, strict=True):
            self.set_state(f"{joint}/{kind}", value)

    def command_before(self, values: Sequence[float], kind: str = "position") -> None:
        """Pretend that this was commanded before."""
        for joint, value in zip(JOINTS, values, strict=True):
            self._commands[self.hardware.command_interfaces.index(f"{joint}/{kind}")] = value

    def set_state(self, name: str, value: float) -> None:
        self._states[self.hardware.state_interfaces.index(name)] = value

    def command(self, name: str) -> float:
        return float(self._commands[self.hardware.command_interfaces.index(name)])

    def _where(self, which: str, names: Sequence[str]) -> list[int]:
        everything = getattr(self.hardware, f"{which}_interfaces")
        return [everything.index(name) for name in names]

    @staticmethod
    def _of(values: np.ndarray, names: Sequence[str], kind: str) -> np.ndarray:
        return np.array([values[names.index(f"{joint}/{kind}")] for joint in JOINTS])


@pytest.fixture
def make_rig() -> Callable[..., Rig]:
    """Make a rig; other keywords are parameters of the controller, '__' standing for a dot."""
    own = ("commands", "states", "positions", "robot_description", "activate")

    def make(**options: Any) -> Rig:
        given = {name: options.pop(name) for name in own if name in options}
        parameters = {name.replace("__", "."): value for name, value in options.items()}
        return Rig(parameters=parameters, **given)

    return make


@pytest.fixture(params=INTERFACES, ids=lambda pair: "-".join("+".join(kinds) for kinds in pair))
def interfaces(request: pytest.FixtureRequest) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return every legal combination of interfaces, one after the other."""
    return request.param


@pytest.fixture
def make_request() -> Callable[..., TrajectoryRequest]:
    return trajectory_request


@pytest.fixture
def robot_description() -> Callable[..., str]:
    """Make a URDF whose joints j0, j1, j2 are all of one type."""

    def make(joint_type: str = "revolute", limit: str = "") -> str:
        limit = limit or '<limit lower="-20" upper="20" effort="9" velocity="50"/>'
        joints = "".join(
            f'<joint name="j{i}" type="{joint_type}"><parent link="l{i}"/>'
            f'<child link="l{i + 1}"/><axis xyz="0 0 1"/>{limit}</joint>'
            for i in range(3)
        )
        links = "".join(f'<link name="l{i}"/>' for i in range(4))
        return f'<robot name="r">{links}{joints}</robot>'

    return make


@pytest.fixture(autouse=True)
def _all_levels(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO)
