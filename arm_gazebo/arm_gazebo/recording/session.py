"""Begin and end recordings of a run that goes on."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from arm_control.errors import StateError
from arm_control.lifecycle import LifecycleState
from arm_control.manager.controller_manager import ControllerManager
from arm_control.manager.loaded_controllers import ManagedController
from arm_control.manager.settings import ManagerSettings
from arm_gazebo.errors import RecordingError
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.model.saved_model import SavedModel
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics.tick import SimulationTick
from arm_gazebo.recording.recorded_run import (
    RecordedRobot,
    RecordedRun,
)
from arm_gazebo.recording.recorder import OnLoop, RunRecorder
from arm_gazebo.recording.run_file import RecordedInput, RunFileWriter
from arm_gazebo.run.robot import AssembledRobot
from arm_gazebo.run.robot_settings import RobotSettings
from arm_gazebo.state.complete_state import CompleteState
from arm_gazebo.state.made_with import made_with

CONFIGURED = (LifecycleState.INACTIVE, LifecycleState.ACTIVE)
LOOP_TIMEOUT_S = 10.0


@dataclass(frozen=True, slots=True)
class RunParts:
    """The parts of a run that a recording needs.

    Attributes:
        simulation: the physics.
        state: the state of the run, which may be restored and reset.
        tick: runs a control period.
        loop: runs the ticks.
        robots: the robots with their settings and those of their managers.
        hold_joints: see `Physics`.
        proportional_gain: see `Physics`.
        seed: seed of the sensors' noise.
    """

    simulation: Physics
    state: CompleteState
    tick: SimulationTick
    loop: OnLoop
    robots: Sequence[tuple[AssembledRobot, RobotSettings, ManagerSettings]]
    hold_joints: bool
    proportional_gain: float
    seed: int

    @property
    def managers(self) -> list[ControllerManager]:
        """The controller managers of the robots."""
        return [robot.manager for robot, _, _ in self.robots]


def begin_recording(run: RunParts, path: Path) -> RunRecorder:
    """Record a run from now on. Any thread but the loop's, unless nobody else runs the loop.

    Args:
        run: the run.
        path: the file, which must not exist.

    Raises:
        RecordingError: the file cannot be written, or the run cannot be recorded.
    """
    built = run.simulation.built
    writer = RunFileWriter(path, header_of(run, built))
    recorder = RunRecorder(run.simulation, run.state, run.managers, run.loop, writer)

    def begin() -> None:
        if run.simulation.built is not built:
            raise RecordingError(
                "the world changed just as the recording began; start the recording again"
            )
        recorder.start(list(first_inputs(run)))
        run.tick.add_feed(recorder)

    try:
        run.loop.call(begin).result(LOOP_TIMEOUT_S)
    except RecordingError:
        writer.close()
        path.unlink(missing_ok=True)
        raise
    return recorder


def end_recording(run: RunParts, recorder: RunRecorder, reason: str = "") -> None:
    """End a recording, and wait for its file. Threads as for `begin_recording`.

    Args:
        run: the run.
        recorder: the recording.
        reason: why it ends; "" if its user ends it.
    """

    def end() -> None:
        run.tick.remove_feed(recorder)
        recorder.stop(reason)

    run.loop.call(end).result(LOOP_TIMEOUT_S)
    recorder.join()


def header_of(run: RunParts, built: BuiltModel) -> Mapping[str, Any]:
    """Return what rebuilds a run.

    Args:
        run: the run.
        built: its model when the recording begins.

    Raises:
        RecordingError: the run is a replay.
    """
    recorded = RecordedRun(
        _pristine(built),
        run.simulation.timing,
        run.hold_joints,
        run.proportional_gain,
        run.seed,
        tuple(
            RecordedRobot(replace(settings, package_path=()), manager, robot.manager.name)
            for robot, settings, manager in run.robots
        ),
    )
    return {"made_with": made_with(), "run": recorded}


def _pristine(built: BuiltModel) -> SavedModel:
    """Return the model as it was before the simulation tuned its drives."""
    if built.spec is None:
        raise RecordingError("a run that is replayed cannot be recorded")
    return SavedModel.of(replace(built, model=built.spec.copy().compile()))


def first_inputs(run: RunParts) -> Iterator[RecordedInput]:
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
    faults = run.simulation.faults.present
    if faults is not None:
        yield RecordedInput(
            0, None, None, run.simulation.resume_faults.__name__, {"present": faults}
        )


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
