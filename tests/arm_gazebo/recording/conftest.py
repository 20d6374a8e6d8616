"""A run that can be recorded: an arm with controllers, without ROS and without threads."""

from collections.abc import Callable
from pathlib import Path

import pytest

from arm_control.controllers.controller import ControllerContext
from arm_control.manager.controller_manager import ControllerManager
from arm_control.manager.registry import controller_class
from arm_control.manager.settings import ManagerSettings
from arm_control.manager.switch_planner import SwitchRequest
from arm_gazebo.model.built_model import SavedModel
from arm_gazebo.physics_timing import physics_timing
from arm_gazebo.recording.recorded_run import RecordedRun
from arm_gazebo.recording.recorder import RunRecorder
from arm_gazebo.recording.replay import Replay, ReplayResult
from arm_gazebo.recording.run_file import RunFile, RunFileWriter
from arm_gazebo.run.robot import ManagedRobot
from arm_gazebo.run.settings import RobotSettings
from arm_gazebo.state.made_with import made_with
from arm_gazebo.world.editor import SpawnRequest, WorldEditor
from arm_gazebo.world.spawn_model import ModelSource

MANAGER = "/controller_manager"


def robot_settings(urdf: str) -> RobotSettings:
    """Return the settings of a robot that is bolted down."""
    return RobotSettings(namespace="", robot_description=urdf)


def load_controller(manager: ControllerManager, document, name: str, type_name: str, **values):
    """Load, configure and activate a controller; return it with its parameters."""
    cls = controller_class(type_name)
    controller = cls(ControllerContext.of(name, 100, document))
    manager.load_controller(controller, type_name)
    given = {spec.name: spec.default for spec in cls.parameter_specs(values)} | values
    parameters = cls.build_parameters(given)
    manager.configure_controller(name, parameters)
    result = manager.switch_controller(SwitchRequest(activate=(name,)))
    assert result.ok, result.message
    return controller, parameters


class RecordedBench:
    """A run with a recorder; `tick` runs one control period."""

    def __init__(self, path: Path, built, urdf: str, seed: int = 0) -> None:
        self.path = path
        timing = physics_timing(100.0)
        robot = ManagedRobot(robot_settings(urdf), ManagerSettings(), MANAGER)
        recorded = RecordedRun(SavedModel.of(built), timing, True, 0.0, seed, (robot,))
        self.rebuilt = recorded.build()
        self.simulation = self.rebuilt.physics
        # The world editor needs a specification, which a saved model lacks.
        self.simulation.built = built
        self.manager: ControllerManager = self.rebuilt.robot.manager
        self.document = self.rebuilt.robot.document
        self.parameters: dict[str, object] = {}
        self.tick, self.state = self.rebuilt.tick, self.rebuilt.state
        writer = RunFileWriter(path, {"made_with": made_with(), "run": recorded})
        self.recorder = RunRecorder(self.rebuilt, writer)
        self.recorder.start()
        self.editor = WorldEditor(
            self.simulation,
            lambda function: function(),
            self.rebuilt.hardware,
            [],
            ModelSource(timing.step_s),
        )

    def start_controller(self, name: str, type_name: str, **values):
        """Load, configure and activate a controller; return it."""
        controller, self.parameters[name] = load_controller(
            self.manager, self.document, name, type_name, **values
        )
        return controller

    def switch(self, **names: tuple[str, ...]) -> None:
        result = self.manager.switch_controller(SwitchRequest(**names))
        assert result.ok, result.message

    def spawn(self, name: str, text: str, pose) -> None:
        self.editor.spawn(SpawnRequest(name, "", text, pose))

    def run(self, periods: int) -> None:
        for _ in range(periods):
            self.tick()

    def finish(self) -> Path:
        """End the recording; return its file."""
        self.recorder.stop()
        self.recorder.join()
        return self.path


@pytest.fixture
def recorded(tmp_path: Path, parts) -> Callable[..., RecordedBench]:
    """Return a maker of recorded runs."""

    def make(urdf: str, name: str = "a.run", world: str = "empty", **more) -> RecordedBench:
        built = parts.build(urdf, world, step_s=physics_timing(100.0).step_s)
        return RecordedBench(tmp_path / name, built, urdf, **more)

    return make


@pytest.fixture
def replayed() -> Callable[..., ReplayResult]:
    """Return a function that runs a recording again."""

    def replay(path: Path, **options) -> ReplayResult:
        return Replay(RunFile(path)).run(**options)

    return replay
