"""A thread that spins an executor, survives exceptions of callbacks, and stops cleanly."""

import logging
import math
import threading
import time
import traceback

from rclpy.executors import Executor, ExternalShutdownException

FAILURE_REPORT_PERIOD_S = 10.0
JOIN_TIMEOUT_S = 5.0
CALLBACKS_TIMEOUT_S = 2.0

logger = logging.getLogger("arm_node")


class _SpinningThread(threading.Thread):
    """A thread that `is_spinning` recognises."""


def is_spinning() -> bool:
    """Return whether an executor's thread is alive, for example after a `stop` that failed."""
    return any(isinstance(thread, _SpinningThread) for thread in threading.enumerate())


class ExecutorThread:
    """Spins an executor in a separate thread, from `start` to `stop`.

    Executor.shutdown does not wait for a spinning thread, but destroys what that thread waits for.
    So the thread is joined before the executor is shut down.
    """

    def __init__(self, name: str, executor: Executor, longest_wait_s: float | None = None) -> None:
        """Prepare the thread.

        Args:
            name: name of the thread.
            executor: the executor to spin; one with several threads serves other callback groups
                while a callback blocks.
            longest_wait_s: maximum wait for work at a time; None waits until there is some.
        """
        self.executor = executor
        self._longest_wait_s = longest_wait_s
        self._stopping = threading.Event()
        self._failures: dict[tuple[type[Exception], str, int | None], float] = {}
        self._thread = _SpinningThread(target=self._spin, name=name, daemon=True)

    def start(self) -> None:
        """Serve the executor's nodes from now on."""
        self._thread.start()

    def stop(self) -> None:
        """Stop spinning, and wait up to 5 s for the running callback.

        A second call does nothing.
        """
        if self._stopping.is_set():
            return
        self._stopping.set()
        if self._thread.ident is not None:
            # `wake` is not enough: without work, the executor goes back to sleep.
            self.executor.create_task(_do_nothing)
            self._thread.join(JOIN_TIMEOUT_S)
            if self._thread.is_alive():
                logger.warning(
                    "a callback in thread '%s' is still running after %g s and is abandoned",
                    self._thread.name,
                    JOIN_TIMEOUT_S,
                )
        self.executor.shutdown(CALLBACKS_TIMEOUT_S)

    def _spin(self) -> None:
        executor = self.executor
        while not self._stopping.is_set() and executor.context.ok():
            try:
                executor.spin_once(self._longest_wait_s)
            except ExternalShutdownException:
                return
            except Exception as error:
                # A callback raised. One bad message must not end the process, so log it and go on.
                self._report(error)

    def _report(self, error: Exception) -> None:
        """Log the traceback; log the same failure at the same place at most every 10 s."""
        last = traceback.extract_tb(error.__traceback__)[-1]
        place = (type(error), last.filename, last.lineno)
        now = time.monotonic()
        if now - self._failures.get(place, -math.inf) >= FAILURE_REPORT_PERIOD_S:
            self._failures[place] = now
            logger.exception("a callback failed; the node goes on")


def _do_nothing() -> None:
    """Do nothing; the task makes `spin_once` return."""
