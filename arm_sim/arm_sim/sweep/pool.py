"""What makes the runs of a study: workers, here the processes of this machine."""

import multiprocessing
import os
import signal
from collections.abc import Iterable
from contextlib import suppress
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Protocol

from arm_sim.sweep.journal import Outcome
from arm_sim.sweep.study import Study, StudyError, Values, find_task
from arm_sim.sweep.task_run import run_once


class WorkerLostError(Exception):
    """A worker has ended; the message says how. It is not for the user."""


class Worker(Protocol):
    """Makes runs, one after the other."""

    def give(self, number: int, values: Values) -> None:
        """Have it make a run. A worker that has ended meanwhile says so in `receive`."""
        ...

    def receive(self) -> Outcome | None:
        """Return the outcome that it has sent; None: it has started and waits for its first run.

        Raises:
            WorkerLostError: it has ended. What it was making is lost.
            StudyError: the study cannot be run there.
        """
        ...

    def end(self) -> None:
        """End it; it makes no run."""
        ...

    def kill(self) -> None:
        """End it at once."""
        ...


class Pool(Protocol):
    """Starts workers, and waits for them. One thread.

    Attributes:
        attempts: how often a run is made whose worker is lost each time.
    """

    attempts: int

    def size(self) -> int:
        """Return how many workers it can have now.

        Raises:
            StudyError: it can have none any more.
        """
        ...

    def add(self) -> Worker:
        """Start a worker."""
        ...

    def wait(self, timeout_s: float) -> Iterable[Worker]:
        """Return the workers that have something to receive; none after the timeout.

        Raises:
            StudyError: no worker can be started.
        """
        ...

    def close(self) -> None:
        """End all workers at once."""
        ...


class ProcessPool:
    """Starts processes that make the runs of a study.

    The recordings of failed runs go to the folder; `size` processes make runs.
    """

    attempts = 2
    """A run whose process dies is made once more: the system may have killed it to free memory."""

    def __init__(self, study: Study, folder: Path, size: int) -> None:
        self._study = study
        self._folder = folder.absolute()
        self._size = size
        self._context = multiprocessing.get_context("spawn")
        self._workers: dict[Connection, _ProcessWorker] = {}

    def size(self) -> int:
        """Return how many processes there can be."""
        return self._size

    def add(self) -> "_ProcessWorker":
        """Start a process."""
        ours, theirs = self._context.Pipe()
        process = self._context.Process(
            target=_work,
            args=(theirs, self._study.task, self._study.seed, self._folder),
            daemon=True,
        )
        process.start()
        # Only the worker may hold its end, so that its death ends the connection.
        theirs.close()
        self._workers[ours] = _ProcessWorker(process, ours)
        return self._workers[ours]

    def wait(self, timeout_s: float) -> Iterable["_ProcessWorker"]:
        """Return the processes that have sent something, or have ended."""
        for connection in [c for c in self._workers if c.closed]:
            del self._workers[connection]
        ready = set(wait(list(self._workers), timeout_s))
        return [worker for connection, worker in self._workers.items() if connection in ready]

    def close(self) -> None:
        """Kill all processes."""
        for worker in self._workers.values():
            worker.kill()


class _ProcessWorker:
    """A process and the connection to it."""

    def __init__(self, process: BaseProcess, connection: Connection) -> None:
        self._process = process
        self._connection = connection
        self._has_started = False

    def give(self, number: int, values: Values) -> None:
        # The connection of a process that has ended meanwhile says so in `receive`.
        with suppress(OSError):
            self._connection.send((number, values))

    def receive(self) -> Outcome | None:
        try:
            message = self._connection.recv()
        except (EOFError, OSError):
            self.end()
            reason = f"ended with exit code {self._process.exitcode}"
            if not self._has_started:
                message = f"a process of the study {reason} before its first run"
                raise StudyError(message) from None
            raise WorkerLostError(f"its process {reason}") from None
        if isinstance(message, StudyError):
            raise message
        self._has_started = True
        return message if isinstance(message, Outcome) else None

    def end(self) -> None:
        self._connection.close()
        self._process.join()

    def kill(self) -> None:
        self._process.kill()
        self.end()


def _work(connection: Connection, task: str, study_seed: int, folder: Path) -> None:
    """Serve a study until the connection ends; the entry of the process.

    The connection gives (number, values), and takes outcomes; the recordings of failed runs go to
    the folder.
    """
    # Ctrl-C is for the process that owns the study; it ends this one.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # The connection fails where the process that owns the study was killed.
    with suppress(EOFError, OSError):
        try:
            function = find_task(task)
        except StudyError as error:
            connection.send(error)
            return
        connection.send(os.getpid())
        while True:
            number, values = connection.recv()
            connection.send(run_once(function, number, values, study_seed, folder))
