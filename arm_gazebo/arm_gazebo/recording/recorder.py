"""Records a run: its inputs with the period in which they take effect, and its states."""

import logging
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Protocol, TypeVar

import mujoco
import numpy as np

from arm_control.controllers.controller import Controller
from arm_control.errors import ArmControlError, LoopStoppedError
from arm_control.loop.clock import Clock, MonotonicClock
from arm_control.manager.controller_manager import ControllerManager
from arm_gazebo.errors import GazeboError
from arm_gazebo.physics.simulation import Simulation
from arm_gazebo.recording.run_file import (
    Record,
    RecordedInput,
    RecordingEnd,
    StateBlock,
)
from arm_gazebo.recording.run_state import Row, StateRow, chained_hash
from arm_gazebo.state.complete_state import CompleteState
from arm_node.plain_data import PlainDataError

ResultT = TypeVar("ResultT")

FLUSH_S = 0.5
"""Wall time after which what there is goes to the file, also while time stands still."""
BLOCK_BYTES = 1 << 20
"""A block of states is not larger. Each one costs a change of threads, which is dear when the
simulation runs as fast as possible."""
MAX_PERIODS = 2000
"""Control periods in a block."""
MAX_BYTES_PER_S = 200_000
"""Of larger states not every one is stored, so that files of large worlds stay small."""

logger = logging.getLogger(__name__)


class OnLoop(Protocol):
    """The loop that runs the simulation."""

    @property
    def is_this_thread(self) -> bool:
        """Whether the caller is on the loop's thread."""
        ...

    def call(self, function: Callable[[], ResultT]) -> "Future[ResultT]":
        """Run a function between two ticks."""
        ...


class RecordWriter(Protocol):
    """Takes the records of a recording. Thread of the recorder's own."""

    @property
    def path(self) -> Path:
        """The file."""
        ...

    def write(self, record: Record) -> None:
        """Take a record, whose arrays are used again; may raise OSError, PlainDataError."""
        ...

    def flush(self) -> None:
        """Hand on everything so far."""
        ...

    def close(self) -> None:
        """Finish."""
        ...


@dataclass(frozen=True, slots=True)
class _Rows:
    """States on their way to the writing thread.

    Attributes:
        first: number of the first period.
        count: number of periods.
        rows: their states, and unused rows after them.
        interval: every how many periods a state is to be stored.
    """

    first: int
    count: int
    rows: Row
    interval: int


class RunRecorder:
    """Notes inputs and states of a run, and writes them on a thread of its own.

    The loop thread only fills rows and puts records into a queue. If the file cannot be written
    any more, the recording ends with `failure`, and the run goes on.

    Args:
        simulation: the simulation; the loop thread owns it.
        state: the state of the run, which may be restored and reset.
        managers: the controller managers of its robots.
        loop: runs them.
        writer: writes the file, which already has its header.
        clock: wall time; default the operating system's monotonic clock.

    Attributes:
        failure: why the recording ended by itself; "" as long as it has not.
        periods: number of control periods recorded so far.
    """

    def __init__(
        self,
        simulation: Simulation,
        state: CompleteState,
        managers: Sequence[ControllerManager],
        loop: OnLoop,
        writer: RecordWriter,
        clock: Clock | None = None,
    ) -> None:
        self.failure = ""
        self.periods = 0
        self._simulation = simulation
        self._complete_state = state
        self._managers = tuple(managers)
        self._loop = loop
        self._writer = writer
        self._now_s = (clock or MonotonicClock()).now_s
        self._is_flush_due = False
        self._flushed_s = self._now_s()
        self._spare_rows: SimpleQueue[Row] = SimpleQueue()
        self._records: SimpleQueue[Record | _Rows | None] = SimpleQueue()
        self._is_inside = False
        self._hash = 0
        self._begin_model()
        self._thread = threading.Thread(target=self._write, name="run recording", daemon=True)

    @property
    def path(self) -> Path:
        """The file."""
        return self._writer.path

    def start(self, first: Iterable[RecordedInput] = ()) -> None:
        """Record from now on. Loop thread, between two ticks, or before the loop runs.

        Args:
            first: inputs that bring a run, as the header rebuilds it, to the present state.
        """
        for item in first:
            self._records.put(item)
        self._thread.start()
        self._set_gate(self)

    def stop(self, reason: str = "") -> None:
        """End the recording. Loop thread, or after the loop has ended; see `join`.

        Args:
            reason: why it ends; "" if its user ends it.
        """
        self._set_gate(None)
        self._end_block()
        self._records.put(RecordingEnd(self.periods, reason))
        self._records.put(None)

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
        if self._loop.is_this_thread:
            return self._note(target, method, arguments, act)
        try:
            return self._loop.call(lambda: self._note(target, method, arguments, act)).result()
        except LoopStoppedError:
            # The run has ended, and with it the recording.
            return act()

    def publish_due(self, time_s: float, data: mujoco.MjData) -> None:
        """Note the state at the end of a control period; see `arm_gazebo.physics.tick.Feed`."""
        if not self._state.is_of(self._simulation):
            self._end_block()
            self._begin_model()
        # After milliseconds of sleep each operation here costs several times its usual time, so the
        # writing thread does what it can: hashes, and a look at the clock.
        self._state.write(self._each_row[self._filled])
        self.periods += 1
        self._filled += 1
        if self._filled == self._periods_in_block or self._is_flush_due:
            self._end_block()

    def _set_gate(self, gate: "RunRecorder | None") -> None:
        self._simulation.input_gate = self._complete_state.input_gate = gate
        for manager in self._managers:
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
            self._records.put(
                RecordedInput(self.periods, robot, controller, method, arguments, raised)
            )

    def _place_of(self, target: object) -> tuple[int | None, str | None]:
        """Return the index of a target's robot, and its name if it is a controller."""
        for index, manager in enumerate(self._managers):
            if target is manager:
                return index, None
            if isinstance(target, Controller):
                managed = manager.controllers.get(target.name)
                if managed is not None and managed.controller is target:
                    return index, target.name
        return None, None

    def _begin_model(self) -> None:
        """Prepare rows for the states of the present model."""
        self._state = StateRow(self._simulation, self._managers)
        period_s = self._simulation.timing.period_s
        self._interval = max(1, round(8 * self._state.width / period_s / MAX_BYTES_PER_S))
        fitting = BLOCK_BYTES // (8 * self._state.width)
        self._periods_in_block = max(1, min(MAX_PERIODS, fitting))
        self._begin_block()

    def _begin_block(self) -> None:
        # The rows of written blocks are reused, because touching fresh memory costs more than
        # noting a state.
        shape = (self._periods_in_block, self._state.width)
        spare = np.empty(0) if self._spare_rows.empty() else self._spare_rows.get()
        self._rows = spare if spare.shape == shape else np.empty(shape)
        self._each_row: list[Row] = list(self._rows[:])
        self._filled = 0
        self._is_flush_due = False

    def _end_block(self) -> None:
        """Hand the block to the writing thread, and begin another one."""
        count = self._filled
        if count:
            self._records.put(_Rows(self.periods - count, count, self._rows, self._interval))
            self._begin_block()

    # The writing thread

    def _write(self) -> None:
        try:
            while self._write_next():
                pass
        except (OSError, PlainDataError) as error:
            reason = error.strerror if isinstance(error, OSError) else str(error)
            self.failure = f"the recording {self.path} ends: {reason}"
            logger.error("%s", self.failure)
            # Until the loop stops the recording, its records must not fill the memory.
            while self._records.get() is not None:
                pass
        finally:
            self._writer.close()

    def _write_next(self) -> bool:
        """Write a record, or flush if none comes; return whether there may be more."""
        try:
            record = self._records.get(timeout=FLUSH_S)
        except Empty:
            self._is_flush_due = True
            return True
        if isinstance(record, _Rows):
            self._writer.write(self._hashed(record))
            self._spare_rows.put(record.rows)
            self._flushed_s = self._now_s()
        elif record is not None:
            self._writer.write(record)
        if self._records.empty():
            self._writer.flush()
        self._is_flush_due = self._is_flush_due or self._now_s() >= self._flushed_s + FLUSH_S
        return record is not None

    def _hashed(self, raw: "_Rows") -> StateBlock:
        hashes = np.empty(raw.count, np.uint64)
        for index in range(raw.count):
            self._hash = hashes[index] = chained_hash(self._hash, raw.rows[index])
        states = raw.rows[: raw.count : raw.interval]
        return StateBlock(raw.first, hashes, raw.interval, states)
