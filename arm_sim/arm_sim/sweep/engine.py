"""Makes the runs of a study in several processes."""

import multiprocessing
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess

from arm_sim.sweep.journal import Journal, Outcome
from arm_sim.sweep.study import Study, StudyError, Values
from arm_sim.sweep.worker import work

POLL_S = 0.2
MAX_ATTEMPTS = 2
"""A run whose process dies is made once more: the system may have killed it to free memory."""


@dataclass
class _Worker:
    """A process and the run that it makes.

    Attributes:
        run: number and values; None while it makes none.
        began_s: when the run began.
    """

    process: BaseProcess
    connection: Connection
    run: tuple[int, Values] | None = None
    began_s: float = 0.0


class Engine:
    """Makes the runs that a journal lacks, and notes what came of each.

    Args:
        study: the study.
        journal: knows the runs that were made before, and takes the others.
        processes: how many processes make runs.
        told: called with each new outcome.
    """

    def __init__(
        self,
        study: Study,
        journal: Journal,
        processes: int,
        told: Callable[[Outcome], object] = lambda _: None,
    ) -> None:
        self._study = study
        self._journal = journal
        self._told = told
        self._attempts: dict[int, int] = {}
        runs = enumerate(study.runs())
        self._waiting: deque[tuple[int, Values]] = deque(
            run for run in runs if run[0] not in journal.outcomes
        )
        self._count = min(processes, len(self._waiting))
        self._context = multiprocessing.get_context("spawn")
        self._workers: list[_Worker] = []

    def run(self) -> None:
        """Make all runs. KeyboardInterrupt ends it; what was noted stays noted.

        Raises:
            StudyError: the task cannot be imported.
        """
        try:
            self._workers = [self._new_worker() for _ in range(self._count)]
            while self._workers:
                ready = wait([worker.connection for worker in self._workers], POLL_S)
                for worker in [w for w in self._workers if w.connection in ready]:
                    self._serve(worker)
                self._end_late_runs()
        finally:
            for worker in self._workers:
                worker.process.kill()
                worker.process.join()

    def _new_worker(self) -> _Worker:
        ours, theirs = self._context.Pipe()
        process = self._context.Process(
            target=work,
            args=(theirs, self._study.task, self._study.seed, self._journal.folder.absolute()),
            daemon=True,
        )
        process.start()
        # Only the worker may hold its end, so that its death ends the connection.
        theirs.close()
        return _Worker(process, ours)

    def _serve(self, worker: _Worker) -> None:
        """Take what a worker has sent, and give it its next run."""
        try:
            message = worker.connection.recv()
        except (EOFError, OSError):
            self._bury(worker)
            return
        if isinstance(message, StudyError):
            raise message
        if isinstance(message, Outcome):
            self._note(message)
        worker.run = None
        if not self._waiting:
            self._workers.remove(worker)
            worker.connection.close()
            worker.process.join()
            return
        worker.run = self._waiting.popleft()
        worker.began_s = time.monotonic()
        # A worker that has died in the meantime ends the connection, which buries it.
        with suppress(OSError):
            worker.connection.send(worker.run)

    def _bury(self, worker: _Worker) -> None:
        """Replace a worker that has died; its run is made again, or has failed."""
        worker.process.join()
        self._workers.remove(worker)
        if worker.run is not None:
            number, values = worker.run
            self._attempts[number] = self._attempts.get(number, 0) + 1
            if self._attempts[number] < MAX_ATTEMPTS:
                self._waiting.append(worker.run)
            else:
                reason = f"its process ended with exit code {worker.process.exitcode}"
                self._note(Outcome(number, values, {}, reason))
        else:
            raise StudyError(
                f"a process of the study ended with exit code {worker.process.exitcode} before "
                "its first run"
            )
        if self._waiting:
            self._workers.append(self._new_worker())

    def _end_late_runs(self) -> None:
        limit_s = self._study.timeout_s
        for worker in list(self._workers):
            if worker.run is None or time.monotonic() - worker.began_s <= limit_s:
                continue
            number, values = worker.run
            worker.run = None
            worker.process.kill()
            worker.process.join()
            self._workers.remove(worker)
            self._note(Outcome(number, values, {}, f"it took more than {limit_s:g} s"))
            if self._waiting:
                self._workers.append(self._new_worker())

    def _note(self, outcome: Outcome) -> None:
        self._journal.add(outcome)
        self._told(outcome)
