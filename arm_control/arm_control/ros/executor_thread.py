"""A thread that serves nodes whose callbacks may block."""

import logging
import threading

from rclpy.executors import (
    Executor,
    ExternalShutdownException,
    ShutdownException,
    SingleThreadedExecutor,
)
from rclpy.node import Node

logger = logging.getLogger(__name__)


class ExecutorThread:
    """An executor of its own in a thread of its own.

    The services of the controller manager wait for the control loop. On the process's own
    executor they would hold up every subscription meanwhile; a coroutine would not help, because
    rclpy's executors sleep on while a future that a coroutine awaits is completed elsewhere.
    """

    def __init__(self, name: str, executor: Executor | None = None) -> None:
        """Prepare the thread.

        Args:
            name: of the thread.
            executor: one with several threads serves on while a callback blocks, what is in other
                callback groups; by default one callback runs after another.
        """
        self._executor = executor or SingleThreadedExecutor()
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._spin, name=name, daemon=True)

    @property
    def executor(self) -> Executor:
        """The executor; for coroutines that wait for other threads, see `executor_bridge`."""
        return self._executor

    def start(self, node: Node) -> None:
        """Serve this node from now on."""
        self._executor.add_node(node)
        self._thread.start()

    def stop(self) -> None:
        """Serve no more, and wait for the callback that is running."""
        self._stopping.set()
        self._executor.shutdown(timeout_sec=2.0)
        if self._thread.ident is not None:
            self._thread.join(timeout=5.0)

    def _spin(self) -> None:
        while not self._stopping.is_set():
            try:
                self._executor.spin()
            except (ExternalShutdownException, ShutdownException):
                return
            except Exception:
                # A callback raised; whoever called it waits in vain, everybody else is served.
                logger.exception("a callback failed; the node goes on")
