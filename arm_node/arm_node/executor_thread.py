"""A thread that spins an executor, outlives what its callbacks raise, and ends in order."""

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
    """Told from others by its class."""


def is_spinning() -> bool:
    """Return whether any executor has a thread that is alive, as after a `stop` in vain."""
    return any(isinstance(thread, _SpinningThread) for thread in threading.enumerate())


class ExecutorThread:
    """Spins an executor in a thread of its own, from `start` to `stop`.

    Executor.shutdown does not wait for a spinning thread, but takes away at once what that thread
    waits for. So the thread goes first, and only then the executor is shut down.
    """

    def __init__(self, name: str, executor: Executor, longest_wait_s: float | None = None) -> None:
        """Prepare the thread.

        Args:
            name: of the thread.
            executor: to spin; one with several threads serves on while a callback blocks, what is
                in other callback groups.
            longest_wait_s: how long to wait for work at a time; None: until there is some.
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
        """Serve no more, and wait for the callback that is running, 5 s at most.

        A second time does nothing.
        """
        if self._stopping.is_set():
            return
        self._stopping.set()
        if self._thread.ident is not None:
            # `wake` would not do: the executor goes back to sleep where it finds no work.
            self.executor.create_task(_do_nothing)
            self._thread.join(JOIN_TIMEOUT_S)
            if self._thread.is_alive():
                logger.warning(
                    "a callback in thread '%s' does not end: left alone after %g s",
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
                # A callback raised. One bad message must not end the process: say it, go on.
                self._report(error)

    def _report(self, error: Exception) -> None:
        """Log the traceback, but the same failure at the same place at most every 10 s."""
        last = traceback.extract_tb(error.__traceback__)[-1]
        place = (type(error), last.filename, last.lineno)
        now = time.monotonic()
        if now - self._failures.get(place, -math.inf) >= FAILURE_REPORT_PERIOD_S:
            self._failures[place] = now
            logger.exception("a callback failed; the node goes on")


def _do_nothing() -> None:
    """Give the executor something to do, so that `spin_once` returns."""
