"""Records each test in memory; a failing test writes its recording to a file."""

from dataclasses import replace
from pathlib import Path

from arm_control.errors import StateError
from arm_gazebo.errors import RecordingError
from arm_gazebo.recording.recorder import RunRecorder
from arm_gazebo.recording.run_file import Record, RecordedInput, RunFileWriter, StateBlock
from arm_gazebo.recording.session import first_inputs, header_of
from arm_sim.assembly import SimulationParts
from arm_sim.recording import run_parts


class BlackBox:
    """Records a simulation from `begin` on. The simulation's thread, between two ticks.

    Attributes:
        refusal: why the run cannot be recorded; "" if it can.
    """

    def __init__(self, parts: SimulationParts) -> None:
        self.refusal = ""
        self._parts = parts
        self._run = run_parts(parts)
        self._recorder: RunRecorder | None = None
        self._first: list[RecordedInput] = []
        self._memory = _Memory()
        self._built = parts.physics.built

    def begin(self, at_start: bool = False) -> None:
        """Record from the present state on.

        Args:
            at_start: whether this is the state in which the first recording began.
        """
        if self._parts.physics.input_gate is not None:
            self.refusal = "the test records its run itself"
            return
        try:
            is_known = at_start and self._first and self._parts.physics.faults.present is None
            first = self._first if is_known else list(first_inputs(self._run))
        except (RecordingError, StateError) as error:
            self.refusal = str(error)
            return
        self._first = self._first or first
        self._memory, self._built = _Memory(), self._parts.physics.built
        run = self._run
        self._recorder = RunRecorder(
            run.simulation, run.state, run.managers, run.loop, self._memory
        )
        self._recorder.start(first)
        run.tick.add_feed(self._recorder)

    def end(self) -> None:
        """Stop; has no effect if nothing is recorded."""
        if self._recorder is not None:
            self._run.tick.remove_feed(self._recorder)
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
