"""What rebuilds a run: its robots, its model, its settings, and what it was made with."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from arm_control.errors import StateError
from arm_control.lifecycle import LifecycleState
from arm_control.manager.loaded_controllers import ManagedController
from arm_gazebo.drives.driven_joint import DriveMode
from arm_gazebo.errors import RecordingError
from arm_gazebo.model.built_model import BuiltModel, SavedModel
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import PhysicsTiming
from arm_gazebo.recording.run_file import RecordedInput, RunFile
from arm_gazebo.run.robot import ManagedRobot, SimulatedRobot
from arm_gazebo.run.run import SimulationRun
from arm_gazebo.state.made_with import made_with
from arm_gazebo.world.loading import WorldLoader

CONFIGURED = (LifecycleState.INACTIVE, LifecycleState.ACTIVE)


@dataclass(frozen=True, slots=True)
class RecordedRun:
    """What rebuilds a run at its beginning.

    Attributes:
        model: the model of the world with its robots, before a simulation changed it.
        timing: control period and physics step.
        hold_joints: see `Physics`.
        proportional_gain: see `Physics`.
        seed: seed of the sensors' noise.
        robots: the robots.
    """

    model: SavedModel
    timing: PhysicsTiming
    hold_joints: bool
    proportional_gain: float
    seed: int
    robots: tuple[ManagedRobot, ...]

    def build(self) -> SimulationRun:
        """Return the run at its beginning; its world is data, which no editor can change.

        Raises:
            GazeboError, ArmControlError, DescriptionError: it cannot be built with what is here.
        """
        model = self.model.load()
        physics = Physics(model, self.timing, self.hold_joints, self.proportional_gain)
        robots = [SimulatedRobot(robot) for robot in self.robots]
        return SimulationRun(robots, physics, WorldLoader(()), self.seed)


def run_of(file: RunFile) -> RecordedRun:
    """Return what rebuilds the run of a file.

    Raises:
        RecordingError: the file does not say that.
    """
    run = file.header.get("run")
    if not isinstance(run, RecordedRun):
        raise RecordingError(f"{file.path} does not say how to build its run")
    return run


def header_of(run: SimulationRun, built: BuiltModel) -> Mapping[str, Any]:
    """Return what a file needs to rebuild a run, which begins with the model `built`.

    Raises:
        RecordingError: the run is a replay.
    """
    if built.spec is None:
        raise RecordingError("a run that is replayed cannot be recorded")
    # The simulation has tuned the drives of its own model.
    pristine = SavedModel.of(replace(built, model=built.spec.copy().compile()))
    robots = [robot.managed for robot in run.robots]
    recorded = RecordedRun(
        pristine,
        run.physics.timing,
        run.physics.idle_mode is DriveMode.HOLD,
        run.physics.servo.proportional_gain,
        run.seed,
        tuple(replace(r, settings=replace(r.settings, package_path=())) for r in robots),
    )
    return {"made_with": made_with(), "run": recorded}


def first_inputs(run: SimulationRun) -> Iterator[RecordedInput]:
    """Return the inputs that lead to the state in which the recording begins. Loop thread.

    Raises:
        RecordingError: a controller's state cannot be saved; the message names it.
    """
    for index, manager in enumerate(run.managers):
        for managed in manager.controllers.values():
            yield from (
                RecordedInput(0, index, None, method, arguments)
                for method, arguments in _loading_steps(managed)
            )
    try:
        state = run.state.save()
    except StateError as error:
        raise RecordingError(f"the run cannot be recorded: {error}") from error
    yield RecordedInput(0, None, None, run.state.restore.__name__, {"saved": state})
    faults = run.physics.faults.present
    if faults is not None:
        yield RecordedInput(0, None, None, run.physics.resume_faults.__name__, {"present": faults})


def _loading_steps(managed: ManagedController) -> Iterator[tuple[str, dict[str, Any]]]:
    yield (
        "load_controller",
        {
            "controller": managed.name,
            "type_name": managed.type_name,
            "fallback_names": managed.fallback_names,
        },
    )
    if managed.state in CONFIGURED:
        yield (
            "configure_controller",
            {
                "name": managed.name,
                "parameters": managed.controller.configured_with,
                "requested_rate_hz": managed.requested_rate_hz,
            },
        )
