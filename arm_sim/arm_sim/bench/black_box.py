"""Records each test in memory; a failing test writes its recording to a file."""

from dataclasses import replace
from pathlib import Path

from arm_control.errors import StateError
from arm_gazebo.errors import RecordingError
from arm_gazebo.recording.recorded_run import first_inputs, header_of
from arm_gazebo.recording.recorder import RunRecorder
from arm_gazebo.recording.run_file import Record, RecordedInput, RunFileWriter, StateBlock
from arm_gazebo.run.run import SimulationRun


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

        Args:
            at_start: whether this is the state in which the first recording began.
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
