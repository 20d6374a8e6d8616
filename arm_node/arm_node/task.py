"""A process that does one thing over ROS and ends: a node, and a function beside its executor."""

import logging
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from arm_node.discovery import answers_held_back
from arm_node.process import EXIT_FAILED, NodeProcess, run_process

if TYPE_CHECKING:
    from rclpy.node import Node

Task = Callable[["Node", NodeProcess], int]
"""Does the work and returns the exit code; on a thread of its own, while the executor spins."""


def run_task(
    node_name: str,
    task: Task,
    argv: Sequence[str] | None = None,
    user_errors: tuple[type[Exception], ...] = (),
) -> int:
    """Run a task until it returns, and return its exit code.

    A signal does not end it: `NodeProcess.stopping` and `NodeProcess.wait` tell the task, which
    then returns soon. The executor serves its node until it has.

    Args:
        node_name: name of the node made for the task.
        task: see `Task`.
        argv: ROS arguments of the process, the program's name first; default sys.argv.
        user_errors: errors whose message is for the user: one FATAL line, no traceback, exit 1.
    """

    @contextmanager
    def application(process: NodeProcess) -> Iterator[None]:
        from rclpy.node import Node

        with answers_held_back():
            node = Node(node_name)
        process.executor.add_node(node)
        worker = threading.Thread(
            target=_work, args=(task, node, process, user_errors), name=node_name, daemon=True
        )
        worker.start()
        yield
        worker.join()

    return run_process(application, argv, user_errors)


def _work(
    task: Task, node: "Node", process: NodeProcess, user_errors: tuple[type[Exception], ...]
) -> None:
    code = EXIT_FAILED
    try:
        code = task(node, process)
    except user_errors as error:
        logging.getLogger(node.get_logger().name).critical("%s", error)
    except Exception:
        # The thread's last frame: whatever went wrong must end the process, and be seen.
        logging.getLogger(node.get_logger().name).exception("the task failed")
    process.stop(code)
