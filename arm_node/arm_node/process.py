"""Start, run and orderly end of a process that holds rclpy nodes.

The main thread only waits for signals; the executor spins in a thread of its own. rclpy's own
signal handlers are off: they raise inside whatever callback runs, and an exit in the middle of
`spin` can abort the interpreter. Order of the end: the application's own teardown (its loop
thread joined, while services still answer), executor, nodes, context. A supervisor is told when
the process is ready (see `arm_node.notify`).
"""

import gc
import logging
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, suppress
from types import FrameType
from typing import TYPE_CHECKING

from arm_node.discovery import answers_held_back
from arm_node.environment import UnusableEnvironmentError, prepare_environment
from arm_node.local_profile import use_local_profile
from arm_node.notify import notify
from arm_node.stop_event import StopEvent

if TYPE_CHECKING:
    from rclpy.node import Node

SWITCH_INTERVAL_S = 0.0005
"""Python's default of 5 ms lets one busy callback delay a control tick by as much."""

SIGNAL_INTERVAL_S = 0.5
"""A signal that another thread got, as after SIGSTOP and SIGCONT, does not wake the main thread."""

EXIT_OK = 0
EXIT_FAILED = 1
EXIT_USAGE = 2


class NodeProcess:
    """The running process as its application sees it: an executor and a way to end.

    `executor` is a SingleThreadedExecutor; add nodes to it. Every method may be called from any
    thread.
    """

    def __init__(self, stop: StopEvent) -> None:
        """Make the executor; `stop` is set to end the process."""
        from rclpy.executors import SingleThreadedExecutor

        from arm_node.executor_thread import ExecutorThread

        self.executor = SingleThreadedExecutor()
        self.exit_code = EXIT_OK
        self._stop = stop
        self._spinning = ExecutorThread("executor", self.executor)

    @property
    def stopping(self) -> bool:
        """Whether the end has been asked for, by a signal or by `stop`."""
        return self._stop.is_set()

    def stop(self, exit_code: int = EXIT_OK) -> None:
        """Ask the process to end with this exit code; the first failure wins."""
        self.exit_code = self.exit_code or exit_code
        self._stop.set()

    def wait(self, timeout_s: float | None = None) -> bool:
        """Block until the end is asked for; return whether it was, within the time-out."""
        if timeout_s is not None:
            return self._stop.wait(timeout_s)
        while not self._stop.wait(SIGNAL_INTERVAL_S):
            pass
        return True

    def start_spinning(self) -> None:
        """Spin the executor in a thread of its own until `join_spinning`."""
        self._spinning.start()

    def join_spinning(self) -> None:
        """Stop the executor and join its thread: a thread still spinning at exit aborts.

        The application may call it at the end of its teardown, before it destroys nodes itself.
        """
        self._spinning.stop()

    def destroy_nodes(self) -> None:
        """Stop the executor and destroy the nodes that it has, unless a callback hangs.

        A node left to the exit of the process is taken down while threads of DDS still use it,
        which now and then is a segmentation fault.
        """
        from arm_node.executor_thread import is_spinning

        nodes = self.executor.get_nodes()  # Before it is shut down: then it forgets them.
        self.join_spinning()
        if not is_spinning():
            for node in nodes:
                node.destroy_node()


Application = Callable[[NodeProcess], AbstractContextManager[None]]
"""Builds the nodes before it yields, tears them down after; runs in the main thread."""


def run_process(
    application: Application,
    argv: Sequence[str] | None = None,
    user_errors: tuple[type[Exception], ...] = (),
) -> int:
    """Run an application until SIGINT, SIGTERM, SIGHUP or its own `stop`; return the exit code.

    A SIGHUP that is ignored already, as under nohup, stays so.

    Args:
        application: builds the nodes, see `Application`.
        argv: ROS arguments of the process, the program's name first; default sys.argv.
        user_errors: errors whose message is for the user: one FATAL line, no traceback, exit 1.
            What rclpy refuses (a parameter's type, a name, a topic of two types) is as well.

    An environment in which ROS cannot start is one sentence on stderr and exit code 2.
    """
    # What is made at the start stays: collecting it again and again would cost start-up time, and
    # later a pause in the middle of a control period.
    gc.disable()
    # Before the imports below, which take some tenths of a second: Ctrl-C is heard from now on.
    with _signals_set(StopEvent()) as stop:
        try:
            prepare_environment()
            use_local_profile(os.environ)
        except UnusableEnvironmentError as error:
            sys.stderr.write(f"{error}\n")
            return EXIT_USAGE
        return _run_with_ros(application, argv, user_errors, stop)


def _run_with_ros(
    application: Application,
    argv: Sequence[str] | None,
    user_errors: tuple[type[Exception], ...],
    stop: StopEvent,
) -> int:
    import rclpy
    from rclpy.impl.implementation_singleton import rclpy_implementation
    from rclpy.signals import SignalHandlerOptions
    from rclpy.utilities import try_shutdown

    sys.setswitchinterval(SWITCH_INTERVAL_S)
    try:
        rclpy.init(
            args=list(sys.argv if argv is None else argv),
            signal_handler_options=SignalHandlerOptions.NO,
        )
    except rclpy_implementation.UnknownROSArgsError as error:
        sys.stderr.write(f"cannot start ROS: unknown words after --ros-args: {error}\n")
        return EXIT_USAGE
    except Exception as error:
        # rcl raises half a dozen unrelated types here, all of them about the arguments given.
        sys.stderr.write(f"cannot start ROS: {first_line(error)}\n")
        return EXIT_USAGE
    try:
        exit_code = _run_initialised(application, user_errors, stop)
    finally:
        try_shutdown()
    _leave_hanging_callbacks(exit_code)
    if exit_code != EXIT_OK:
        # A node that was refused half made is not the executor's, but stands in reference cycles.
        gc.collect()
    return exit_code


def _leave_hanging_callbacks(exit_code: int) -> None:
    """Exit at once where a callback does not end.

    Python's own teardown would end its thread as soon as that comes back from rclpy, in the midst
    of C++, which aborts the process.
    """
    from arm_node.executor_thread import is_spinning

    if is_spinning():
        for stream in filter(None, (sys.stdout, sys.stderr)):
            with suppress(OSError, ValueError):
                stream.flush()
        os._exit(exit_code)


def _run_initialised(
    application: Application, user_errors: tuple[type[Exception], ...], stop: StopEvent
) -> int:
    from arm_node.log_bridge import bridge_logging

    process = NodeProcess(stop)
    with bridge_logging():
        try:
            with application(process):
                process.start_spinning()
                gc.freeze()
                gc.enable()
                notify("READY=1")
                process.wait()
                notify("STOPPING=1")
        except user_errors as error:
            logging.getLogger("arm_node").critical("%s", error)
            process.stop(EXIT_FAILED)
        except _refusals() as error:
            logging.getLogger("arm_node").critical("cannot make the node: %s", first_line(error))
            process.stop(EXIT_FAILED)
        finally:
            process.destroy_nodes()
    return process.exit_code


def run_node(
    node_class: Callable[[], "Node"],
    argv: Sequence[str] | None = None,
    user_errors: tuple[type[Exception], ...] = (),
) -> int:
    """Run one node that needs nothing but an executor; see `run_process`."""

    @contextmanager
    def application(process: NodeProcess) -> Iterator[None]:
        with answers_held_back():
            node = node_class()
        process.executor.add_node(node)
        yield

    return run_process(application, argv, user_errors)


def _refusals() -> tuple[type[Exception], ...]:
    """Return what rclpy raises where parameters, names or topics given to a node cannot be."""
    from rclpy.exceptions import NameValidationException, ParameterException
    from rclpy.qos_overriding_options import InvalidQosOverridesError

    # A RuntimeError is what rcl itself refuses, and a QoS policy of no such value.
    return (ParameterException, NameValidationException, InvalidQosOverridesError, RuntimeError)


def first_line(error: BaseException) -> str:
    """Return the first line of an error's message: rcl appends C source positions to it."""
    text = str(error).strip()
    return text.splitlines()[0] if text else type(error).__name__


@contextmanager
def _signals_set(stop: StopEvent) -> Iterator[StopEvent]:
    """Let the signals that mean the end set an event, and nothing else."""

    def ask_to_stop(_number: int, _frame: FrameType | None) -> None:
        stop.set()

    numbers = [signal.SIGINT, signal.SIGTERM]
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:  # nohup
        numbers.append(signal.SIGHUP)
    previous = {number: signal.signal(number, ask_to_stop) for number in numbers}
    try:
        yield stop
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
