"""The simulation of a test: the library's, with assertions about everything that has happened.

A session builds each once and restores it for later tests; each is recorded, for those that fail.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from shlex import quote
from typing import Any

from arm_control.errors import StateError
from arm_gazebo.errors import RecordingError, RequestError
from arm_gazebo.recording.recorded_run import first_inputs, header_of
from arm_gazebo.recording.recorder import RunRecorder
from arm_gazebo.recording.run_file import Record, RecordedInput, RunFileWriter, StateBlock
from arm_gazebo.run.run import SimulationRun
from arm_gazebo.world.contacts import bodies_of
from arm_gazebo.world.entity import WORLD_FRAME
from arm_sim.bench.configuration import configuration_key
from arm_sim.bench.expectations import JointAssertions
from arm_sim.bench.history import StateHistory
from arm_sim.bench.touches import Touch, TouchLog
from arm_sim.errors import CallError
from arm_sim.faults import SimulationFaults
from arm_sim.joints import Joints
from arm_sim.robots import AnyPath
from arm_sim.simulation import Simulation
from arm_sim.snapshots import SavedState

PLOT = "joints.png"
RECORDING = "test.run"
SHOWN_TOUCHES = 8


class BenchSimulation(Simulation, JointAssertions):
    """A `Simulation` that remembers what happened, for the assertions and reports of a test.

    Attributes:
        history: the states of the joints since the test began.
        touches: the bodies that have touched each other since then.
        faults: faults for the duration of a `with` block.
        first_seed: seed of the noise at the start.
    """

    def __init__(self, *, robot: AnyPath = "arm", **arguments: Any) -> None:
        """Build it; `robot` is the description, and the others are `Simulation`'s arguments."""
        super().__init__(robot, **arguments)
        self.first_seed = self.parts.seed
        joints = self._physics.built.joints
        units = ["m" if joints[name].linear else "rad" for name in self.joints.names]
        self.history = StateHistory(self.joints.names, units)
        self.touches = TouchLog()
        self.faults = SimulationFaults(self.parts, self.controllers, self.camera)
        self._observer = _StateObserver(self.joints, self.history, self.touches)
        self._tick.add_feed(self._observer)
        self._black_box = BlackBox(self.parts)
        self._begin()

    def restore(self, snapshot: SavedState | AnyPath) -> None:
        """Go back to a state; the history and the recording begin there. See `Simulation`."""
        self._black_box.end()
        super().restore(snapshot)
        self._begin()

    def reset(self, seed: int | None = None) -> None:
        """Go back to the start; the history and the recording begin there. See `Simulation`."""
        self._black_box.end()
        super().reset(seed)
        self._begin(at_start=seed == self.first_seed)

    def close(self) -> None:
        """End everything; may be called again."""
        self._black_box.end()
        super().close()

    def _begin(self, at_start: bool = False) -> None:
        self._black_box.begin(at_start)
        self.history.clear()
        self.touches.clear()
        self.faults.log.restart()
        self._observer.publish_due(self.time_s, self._physics.data)

    # Assertions

    def assert_no_contact(self, name: str | None = None, *, allow: Sequence[str] = ()) -> None:
        """Check that something has touched nothing since the test began.

        Args:
            name: an entity or a link; None for the robot.
            allow: entities or links that it may touch; "world" for the world.

        Raises:
            AssertionError: it has touched something else; the message says what and when.
            RequestError: there is no entity or link of that name.
        """
        __tracebackhide__ = True
        whose = self._bodies(name)
        allowed = {body for other in allow for body in self._bodies(other)}
        found = [
            touch
            for touch in self.touches.touches
            if whose.intersection(touch.bodies) and not allowed.intersection(touch.bodies)
        ]
        if found:
            raise AssertionError("\n".join(map(str, _shown(found))))

    def _bodies(self, name: str | None) -> frozenset[str]:
        if name == WORLD_FRAME:
            return frozenset((WORLD_FRAME,))
        names = list(self._physics.built.robots) if name is None else [name]
        model, entities = self._physics.model, self._open.editor.entities
        numbers = frozenset().union(*(bodies_of(each, model, entities) for each in names))
        return frozenset(model.body(number).name for number in numbers)

    def _circumstances(self) -> Iterator[str]:
        for touch in _shown(self.touches.present):
            yield f"meanwhile {touch}"
        yield from map(str, self.faults.log.spans)

    # The report

    def report(self, folder: Path) -> Iterator[str]:
        """Write files that explain a failure; yield a line for each.

        Args:
            folder: an existing folder for the files.

        Raises:
            OSError, GazeboError: a file cannot be written.
        """
        from arm_sim.bench.joint_plot import save_plot

        save_plot(self.history, folder / PLOT, self.faults.log.spans)
        yield f"joints: {folder / PLOT}"
        if self._black_box.refusal:
            yield f"not recorded: {self._black_box.refusal}"
            return
        self._black_box.write(folder / RECORDING)
        yield f"run it again: arm sim replay {quote(str(folder / RECORDING))}"


class _StateObserver:
    """Adds the state after each tick to the history."""

    def __init__(self, joints: Joints, history: StateHistory, touches: TouchLog) -> None:
        self._joints, self._history, self._touches = joints, history, touches

    def publish_due(self, time_s: float, data: Any) -> None:
        joints = self._joints
        self._history.add(time_s, joints.position, joints.velocity, joints.effort)
        self._touches.note(time_s, data)


def _shown(touches: Sequence[Touch]) -> Iterator[Touch | str]:
    yield from touches[:SHOWN_TOUCHES]
    if len(touches) > SHOWN_TOUCHES:
        yield f"and {len(touches) - SHOWN_TOUCHES} more contacts"


class BlackBox:
    """Records a simulation from `begin` on. The simulation's thread, between two ticks.

    Attributes:
        refusal: why the run cannot be recorded; "" if it can.
    """

    def __init__(self, run: SimulationRun) -> None:
        self.refusal = ""
        self._run = run
        self._recorder: RunRecorder | None = None
        self._first: list[RecordedInput] = []
        self._memory = _Memory()
        self._built = run.physics.built

    def begin(self, at_start: bool = False) -> None:
        """Record from the present state on.

        `at_start` says that it is the state in which the first recording began.
        """
        if self._run.physics.input_gate is not None:
            self.refusal = "the test records its run itself"
            return
        try:
            is_known = at_start and self._first and self._run.physics.faults.present is None
            first = self._first if is_known else list(first_inputs(self._run))
        except (RecordingError, StateError) as error:
            self.refusal = str(error)
            return
        self._first = self._first or first
        self._memory, self._built = _Memory(), self._run.physics.built
        self._recorder = RunRecorder(self._run, self._memory)
        self._recorder.start(first)

    def end(self) -> None:
        """Stop; has no effect if nothing is recorded."""
        if self._recorder is not None:
            self._recorder.stop()
            self._recorder.join()
            self._recorder = None

    def write(self, path: Path) -> None:
        """Stop, and write the recording to a file that does not exist.

        Raises:
            RecordingError, OSError: it cannot be written.
        """
        self.end()
        writer = RunFileWriter(path, header_of(self._run, self._built))
        try:
            for record in self._memory.records:
                writer.write(record)
        finally:
            writer.close()


class _Memory:
    """Keeps the records of a run: the hash of every state, and a whole state now and then."""

    path = Path()

    def __init__(self) -> None:
        self.records: list[Record] = []

    def write(self, record: Record) -> None:
        if isinstance(record, StateBlock):
            # A replay compares the hashes; the states are 100 times larger.
            sparse = record.states[:1].copy()
            record = replace(record, interval=len(record.hashes), states=sparse)
        self.records.append(record)

    def flush(self) -> None:
        pass

    def close(self) -> None:
        pass


class SimulationPool:
    """Gives each test a simulation of its configuration, in its initial state."""

    def __init__(self) -> None:
        self._built: dict[str, BenchSimulation] = {}

    def take(self, arguments: dict[str, Any]) -> BenchSimulation:
        """Return a simulation in its initial state, with these arguments of `BenchSimulation`.

        Raises:
            DescriptionError, GazeboError, ArmControlError, ParameterValueError: it cannot be built.
        """
        key = configuration_key(arguments)
        known = self._built.pop(key, None)
        simulation = known if known is not None and _is_restored(known) else None
        self._built[key] = simulation = simulation or BenchSimulation(**arguments)
        return simulation

    def close(self) -> None:
        """Close all of them."""
        for simulation in self._built.values():
            simulation.close()
        self._built.clear()


def _is_restored(simulation: BenchSimulation) -> bool:
    """Bring a simulation back to its start; if that is impossible, close it and return False."""
    try:
        simulation.reset(simulation.first_seed)
    except (StateError, CallError, RequestError):
        # The state of a controller cannot be saved, or a test has closed the simulation.
        simulation.close()
        return False
    return True
