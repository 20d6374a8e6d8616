"""Hands the runs of a study to the workers of a pool, and notes what came of each."""

import math
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from arm_sim.sweep.journal import Journal, Outcome
from arm_sim.sweep.pool import Pool, Worker, WorkerLostError
from arm_sim.sweep.study import Study, Values

POLL_S = 0.2


@dataclass(frozen=True, slots=True)
class _Assignment:
    """A run that a worker makes.

    Attributes:
        number: the run's number.
        values: its values.
        began_s: when the worker got it.
    """

    number: int
    values: Values
    began_s: float


class Engine:
    """Makes the runs that a journal lacks, and notes what came of each.

    The engine closes the pool; `told` is called with each new outcome.
    """

    def __init__(
        self,
        study: Study,
        journal: Journal,
        pool: Pool,
        told: Callable[[Outcome], object] = lambda _: None,
    ) -> None:
        self._journal = journal
        self._pool = pool
        self._told = told
        self._timeout_s = study.timeout_s
        self._waiting: deque[tuple[int, Values]] = deque(
            run for run in enumerate(study.runs()) if run[0] not in journal.outcomes
        )
        self._losses: dict[int, int] = {}
        self._workers: set[Worker] = set()
        self._runs: dict[Worker, _Assignment] = {}

    def run(self) -> None:
        """Make all runs. KeyboardInterrupt ends it; what was noted stays noted.

        Raises:
            StudyError: the task cannot be imported, or there are no workers.
        """
        try:
            while self._waiting or self._runs:
                self._add_workers()
                for worker in self._pool.wait(POLL_S):
                    if worker in self._workers:
                        self._serve(worker)
                self._end_late_runs()
        finally:
            self._pool.close()

    def _add_workers(self) -> None:
        """Have a worker for each run that waits or is made, as far as the pool has them."""
        wanted = min(self._pool.size(), len(self._waiting) + len(self._runs))
        while len(self._workers) < wanted:
            self._workers.add(self._pool.add())

    def _serve(self, worker: Worker) -> None:
        """Take what a worker has sent, and give it its next run."""
        try:
            outcome = worker.receive()
        except WorkerLostError as lost:
            self._workers.remove(worker)
            self._make_again(self._runs.pop(worker, None), str(lost))
            return
        self._runs.pop(worker, None)
        if outcome is not None:
            self._note(outcome)
        if not self._waiting:
            self._workers.remove(worker)
            worker.end()
            return
        number, values = self._waiting.popleft()
        self._runs[worker] = _Assignment(number, values, time.monotonic())
        worker.give(number, values)

    def _make_again(self, run: _Assignment | None, reason: str) -> None:
        """Queue a run whose worker is lost, or note that it has failed."""
        if run is None:
            return
        losses = self._losses[run.number] = self._losses.get(run.number, 0) + 1
        if losses < self._pool.attempts:
            self._waiting.append((run.number, run.values))
        else:
            self._note(Outcome(run.number, run.values, {}, reason))

    def _end_late_runs(self) -> None:
        if math.isinf(self._timeout_s):
            return
        earliest_s = time.monotonic() - self._timeout_s
        for worker, run in list(self._runs.items()):
            if run.began_s < earliest_s:
                worker.kill()
                self._workers.remove(worker)
                del self._runs[worker]
                error = f"it took more than {self._timeout_s:g} s"
                self._note(Outcome(run.number, run.values, {}, error))

    def _note(self, outcome: Outcome) -> None:
        self._journal.add(outcome)
        self._told(outcome)
