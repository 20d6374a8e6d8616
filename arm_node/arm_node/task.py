"""A process that performs one task over ROS and ends: a node, and a function beside it."""

import logging
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from arm_node.process import EXIT_FAILED, NodeProcess, run_process
from arm_node.workarounds.discovery import first_node

if TYPE_CHECKING:
    from rclpy.node import Node

Task = Callable[["Node", NodeProcess], int]
"""Does the work and returns the exit code; runs on its own thread while the executor spins."""


def run_task(
    node_name: str,
    task: Task,
    argv: Sequence[str] | None = None,
    user_errors: tuple[type[Exception], ...] = (),
    packages: Sequence[str] = (),
) -> int:
    """Run a task until it returns, and return its exit code.

    A signal does not end it: the task checks `NodeProcess.stopping` or `NodeProcess.wait` and must
    return soon. The executor serves its node until then.

    Args:
        node_name: name of the task's node.
        task: see `Task`.
        argv: ROS arguments of the process, after the program's name; default sys.argv.
        user_errors: errors with messages for the user: one FATAL line, no traceback, exit code 1.
        packages: further interface packages that it needs, see `run_process`.
    """

    @contextmanager
    def application(process: NodeProcess) -> Iterator[None]:
        from rclpy.node import Node

        node = first_node(lambda: Node(node_name))
        process.executor.add_node(node)
        worker = threading.Thread(
            target=_work, args=(task, node, process, user_errors), name=node_name, daemon=True
        )
        worker.start()
        yield
        worker.join()

    return run_process(application, argv, user_errors, packages)


def _work(
    task: Task, node: "Node", process: NodeProcess, user_errors: tuple[type[Exception], ...]
) -> None:
    code = EXIT_FAILED
    try:
        code = task(node, process)
    except user_errors as error:
        logging.getLogger(node.get_logger().name).critical("%s", error)
    except Exception:
        # The thread's outermost frame: any error must be logged and end the process.
        logging.getLogger(node.get_logger().name).exception("the task failed")
    process.stop(code)
