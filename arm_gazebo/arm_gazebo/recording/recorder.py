"""Records a run: its inputs with the period in which they take effect, and its states."""

import logging
import threading
from array import array
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Protocol, Self, TypeVar

import mujoco
import numpy as np

from arm_control.controllers.controller import Controller
from arm_control.errors import ArmControlError, LoopStoppedError
from arm_control.state.encoding import NotPlainError
from arm_gazebo.errors import GazeboError, RecordingError
from arm_gazebo.recording.recorded_run import first_inputs, header_of
from arm_gazebo.recording.run_file import (
    Record,
    RecordedInput,
    RecordingEnd,
    RunFileWriter,
    StateBlock,
)
from arm_gazebo.recording.run_state import StateRow, chained_hashes
from arm_gazebo.run.run import LOOP_TIMEOUT_S, SimulationRun

ResultT = TypeVar("ResultT")

FLUSH_S = 0.5
"""Wall time after which what there is goes to the file."""
BLOCK_BYTES = 1 << 20
"""A block of states is not larger. Each full one wakes the writing thread, which is dear when the
simulation runs as fast as possible."""
MAX_PERIODS = 2000
"""Control periods in a block."""
MAX_BYTES_PER_S = 200_000
"""Of larger states not every one is stored, so that files of large worlds stay small."""

logger = logging.getLogger(__name__)


class RecordWriter(Protocol):
    """Takes the records of a recording. Thread of the recorder's own."""

    @property
    def path(self) -> Path:
        """The file."""
        ...

    def write(self, record: Record) -> None:
        """Take a record; may raise OSError, NotPlainError."""
        ...

    def flush(self) -> None:
        """Hand on everything so far."""
        ...

    def close(self) -> None:
        """Finish."""
        ...


class _StateQueue:
    """States of one model that are not in the file yet.

    The loop thread appends to them while the writing thread takes what is there.

    Attributes:
        first: number of the first period; the writing thread's.
        each: a copy of each state.
        width: numbers in each.
        interval: every how many periods a state is to be stored.
    """

    __slots__ = ("each", "first", "interval", "width")

    def __init__(self, first: int, width: int, interval: int) -> None:
        self.first = first
        self.each: list[bytes] = []
        self.width = width
        self.interval = interval

    def take(self, count: int, previous: int) -> StateBlock:
        """Take out the first states, so that the next ones get their memory; writing thread.

        `previous` is the hash after the period before.
        """
        first, states = self.first, self.each[:count]
        self.first += count
        # Python's lock makes this one step for the loop thread.
        del self.each[:count]
        hashes = np.fromiter(chained_hashes(previous, states), np.uint64, count)
        stored = np.frombuffer(b"".join(states[:: self.interval]))
        return StateBlock(first, hashes, self.interval, stored.reshape(-1, self.width))


class RunRecorder:
    """Notes inputs and states of a run, and writes them on a thread of its own.

    The loop thread only copies states and lists inputs. It does not wake the writing thread but for
    full blocks: the two would compete for Python's lock in the middle of a tick. If the file cannot
    be written any more, the recording ends with `failure`, and the run goes on. The writer's file
    already has its header.

    Attributes:
        failure: why the recording ended by itself; "" as long as it has not.
        periods: number of control periods recorded so far.
    """

    def __init__(self, run: SimulationRun, writer: RecordWriter) -> None:
        self.failure = ""
        self.periods = 0
        self._run = run
        self._writer = writer
        self._records: deque[Record | _StateQueue | None] = deque()
        self._wake: SimpleQueue[None] = SimpleQueue()
        self._is_inside = False
        self._hash = 0
        self._begin_model()
        self._thread = threading.Thread(target=self._write, name="run recording", daemon=True)

    @property
    def path(self) -> Path:
        """The file."""
        return self._writer.path

    @classmethod
    def to_file(cls, run: SimulationRun, path: Path) -> Self:
        """Record a run to a new file from now on. Not on the loop's thread.

        Raises:
            RecordingError: the file cannot be written, or the run cannot be recorded.
        """
        built = run.physics.built
        writer = RunFileWriter(path, header_of(run, built))
        recorder = cls(run, writer)

        def begin() -> None:
            if run.physics.built is not built:
                raise RecordingError(
                    "the world changed just as the recording began; start the recording again"
                )
            recorder.start(list(first_inputs(run)))

        try:
            run.loop.call(begin).result(LOOP_TIMEOUT_S)
        except RecordingError:
            writer.close()
            path.unlink(missing_ok=True)
            raise
        return recorder

    def end(self, reason: str = "") -> None:
        """End the recording, and wait for its file. Not on the loop's thread.

        Args:
            reason: why it ends; "" if its user ends it.
        """
        self._run.loop.call(lambda: self.stop(reason)).result(LOOP_TIMEOUT_S)
        self.join()

    def start(self, first: Iterable[RecordedInput] = ()) -> None:
        """Record from now on. Loop thread, between two ticks, or before the loop runs.

        The inputs in `first` bring a run, as the header rebuilds it, to the present state.
        """
        self._records.extend(first)
        self._thread.start()
        self._set_gate(self)
        self._run.tick.add_feed(self)

    def stop(self, reason: str = "") -> None:
        """End the recording. Loop thread, or after the loop has ended; see `join`.

        Args:
            reason: why it ends; "" if its user ends it.
        """
        self._run.tick.remove_feed(self)
        self._set_gate(None)
        self._end_block()
        self._records.extend((RecordingEnd(self.periods, reason), None))
        self._wake.put(None)

    def join(self) -> None:
        """Wait until the file is complete, after `stop`. Not on the loop thread."""
        self._thread.join()

    def give(
        self,
        target: object,
        method: str,
        arguments: Mapping[str, object],
        act: Callable[[], ResultT],
        /,
    ) -> ResultT:
        """Run an input on the loop thread, between two ticks, and note it; any thread."""
        if self._run.loop.is_this_thread:
            return self._note(target, method, arguments, act)
        try:
            return self._run.loop.call(lambda: self._note(target, method, arguments, act)).result()
        except LoopStoppedError:
            # The run has ended, and with it the recording.
            return act()

    def publish_due(self, time_s: float, data: mujoco.MjData) -> None:
        """Note the state at the end of a control period; see `arm_gazebo.physics.tick.Feed`."""
        if data is not self._state.data:
            self._end_block()
            self._begin_model()
        each = self._states.each
        each.append(self._state.copy(time_s))
        self.periods += 1
        if len(each) >= self._periods_in_block:
            self._end_block()

    def _set_gate(self, gate: "RunRecorder | None") -> None:
        self._run.physics.input_gate = self._run.state.input_gate = gate
        for manager in self._run.managers:
            manager.set_input_gate(gate)

    def _note(
        self,
        target: object,
        method: str,
        arguments: Mapping[str, object],
        act: Callable[[], ResultT],
    ) -> ResultT:
        if self._is_inside:
            # A replay repeats what an input does by other inputs without being told.
            return act()
        raised = False
        self._is_inside = True
        try:
            return act()
        except (ArmControlError, GazeboError, ValueError):
            raised = True
            raise
        finally:
            self._is_inside = False
            robot, controller = self._place_of(target)
            # A sequence of a ROS message is noted as NumPy's array, as any other.
            noted = {
                name: np.array(value) if isinstance(value, array) else value
                for name, value in arguments.items()
            }
            self._records.append(
                RecordedInput(self.periods, robot, controller, method, noted, raised)
            )

    def _place_of(self, target: object) -> tuple[int | None, str | None]:
        """Return the index of a target's robot, and its name if it is a controller."""
        for index, manager in enumerate(self._run.managers):
            if target is manager:
                return index, None
            if isinstance(target, Controller):
                managed = manager.controllers.get(target.name)
                if managed is not None and managed.controller is target:
                    return index, target.name
        return None, None

    def _begin_model(self) -> None:
        """Note the states of the present model from now on."""
        self._state = StateRow(self._run.physics, self._run.managers)
        width, period_s = self._state.width, self._run.physics.timing.period_s
        interval = max(1, round(8 * width / period_s / MAX_BYTES_PER_S))
        self._periods_in_block = max(1, min(MAX_PERIODS, BLOCK_BYTES // (8 * width)))
        self._states = _StateQueue(self.periods, width, interval)

    def _end_block(self) -> None:
        """Hand the states to the writing thread, and begin to fill others."""
        full = self._states
        if full.each:
            self._states = _StateQueue(self.periods, full.width, full.interval)
            self._records.append(full)
            self._wake.put(None)

    # The writing thread

    def _write(self) -> None:
        try:
            self._write_until_end()
        except (OSError, NotPlainError) as error:
            reason = (
                error.strerror
                if isinstance(error, OSError)
                else f"the input{error.path} {error.reason}"
            )
            self.failure = f"the recording {self.path} ends: {reason}"
            logger.error("%s", self.failure)
            # Until the loop stops the recording, its records must not fill the memory.
            self._write_until_end()
        finally:
            self._writer.close()

    def _write_until_end(self) -> None:
        """Write what there is, again and again, until the loop ends the recording."""
        is_going_on = True
        while is_going_on:
            try:
                self._wake.get(timeout=FLUSH_S)
                is_going_on = self._write_listed(None)
            except Empty:
                is_going_on = self._write_listed(self._states)
            if not self.failure:
                self._writer.flush()

    def _write_listed(self, unfinished: _StateQueue | None) -> bool:
        """Write inputs, full blocks, and what there is of one; return whether more will come."""
        # Read first: the inputs that took effect before these periods are listed by now.
        count = 0 if unfinished is None else len(unfinished.each)
        while self._records:
            record = self._records.popleft()
            if record is None:
                return False
            if isinstance(record, _StateQueue):
                self._write_states(record, len(record.each))
            else:
                self._write_record(record)
        if unfinished is not None:
            # If the loop has ended the block meanwhile, all its states are written already.
            self._write_states(unfinished, min(count, len(unfinished.each)))
        return True

    def _write_states(self, states: _StateQueue, count: int) -> None:
        if count:
            block = states.take(count, self._hash)
            self._hash = int(block.hashes[-1])
            self._write_record(block)

    def _write_record(self, record: Record) -> None:
        if not self.failure:
            self._writer.write(record)


@contextmanager
def recording(run: SimulationRun, path: Path) -> Iterator[None]:
    """Record a run to a new file, from now on to the end of the `with` block.

    Raises:
        RecordingError: the file cannot be written, or the run cannot be recorded.
    """
    recorder = RunRecorder.to_file(run, path)
    reason = "the program failed"
    try:
        yield
        reason = ""
    finally:
        recorder.end(reason)
