"""What makes the runs of a study: workers, on this machine or on others."""

from collections.abc import Iterable
from typing import Protocol

from arm_sim.sweep.journal import Outcome
from arm_sim.sweep.study import Values


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
