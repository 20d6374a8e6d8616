"""Starts, runs and shuts down a process with rclpy nodes.

The main thread only waits for signals; the executor spins in a separate thread. rclpy's own signal
handlers are off: they raise inside the running callback, and an exit in the middle of `spin` can
abort the interpreter. Shutdown order: the application's teardown (it joins its loop thread while
services still answer), executor, nodes, context. A supervisor is told when the process is ready
(see `arm_node.notify`).
"""

import gc
import logging
import os
import select
import signal
import sys
import traceback
import warnings
import weakref
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, suppress
from itertools import pairwise
from types import FrameType

from arm_node.environment import UnusableEnvironmentError, prepare_environment
from arm_node.notify import notify
from arm_node.parameter_values import ParameterValueError
from arm_node.printable import first_line, printable, printable_message
from arm_node.user_file import MAX_TEXT_BYTES, check_file
from arm_node.workarounds.deadlocked_end import DestructionLimit
from arm_node.workarounds.local_profile import use_local_profile
from arm_node.workarounds.private_files import hide_shared_memory, made_private
from arm_node.workarounds.switch import switched_off

SWITCH_INTERVAL_S = 0.0005
"""Python's default of 5 ms lets one busy callback delay a control tick by as much."""

SIGNAL_INTERVAL_S = 0.5
"""A signal that another thread receives, as after SIGSTOP, does not wake the main thread."""

FILE_ARGUMENTS = ("--params-file", "--log-config-file")
"""ROS arguments that a file follows."""

MS_PER_S = 1000.0

EXIT_OK = 0
EXIT_FAILED = 1
EXIT_USAGE = 2


class StopEvent:
    """Like `threading.Event`, but safe in signal handlers; once set, it stays set.

    Python runs a handler in the main thread, between two steps of the code there. Within
    `threading.Event.wait` that may be while it holds the event's lock, and `set` in the handler
    would then wait for that lock for ever. Here a pipe replaces the lock: `set` writes to it, and
    no thread reads from it, so it is readable for all waiting threads, now and later.

    Every method may be called from any thread and from a signal handler.
    """

    def __init__(self) -> None:
        """Open the pipe; it is closed with the last reference to this object."""
        self._readable, self._writable = os.pipe()
        os.set_blocking(self._writable, False)
        self._is_set = False
        weakref.finalize(self, _close, self._readable, self._writable)

    def is_set(self) -> bool:
        """Return whether `set` was called."""
        return self._is_set

    def set(self) -> None:
        """Wake all waiting threads; a second call does nothing."""
        if not self._is_set:
            self._is_set = True
            os.write(self._writable, b"\0")

    def wait(self, timeout_s: float | None = None) -> bool:
        """Block until `set` is called; return whether it was, within the timeout in s."""
        poll = select.poll()
        poll.register(self._readable, select.POLLIN)
        return bool(poll.poll(None if timeout_s is None else timeout_s * MS_PER_S))


def _close(*descriptors: int) -> None:
    for descriptor in descriptors:
        os.close(descriptor)


class NodeProcess:
    """The running process, as passed to its application: an executor and a way to stop.

    `executor` is a SingleThreadedExecutor; add nodes to it. Every method may be called from any
    thread.
    """

    def __init__(self, stop: StopEvent) -> None:
        """Create the executor; `stop` is set to end the process."""
        from rclpy.executors import SingleThreadedExecutor

        from arm_node.executor_thread import ExecutorThread

        self.executor = SingleThreadedExecutor()
        self.exit_code = EXIT_OK
        self._stop = stop
        self._destruction = DestructionLimit()
        self._spinning = ExecutorThread("executor", self.executor)

    @property
    def stopping(self) -> bool:
        """Whether shutdown was requested, by a signal or by `stop`."""
        return self._stop.is_set()

    def stop(self, exit_code: int = EXIT_OK) -> None:
        """Request shutdown with this exit code; the first failure wins."""
        self.exit_code = self.exit_code or exit_code
        self._stop.set()

    def wait(self, timeout_s: float | None = None) -> bool:
        """Block until shutdown is requested; return whether it was within the timeout."""
        if timeout_s is not None:
            return self._stop.wait(timeout_s)
        while not self._stop.wait(SIGNAL_INTERVAL_S):
            pass
        return True

    def start_spinning(self) -> None:
        """Spin the executor in a separate thread until `join_spinning`."""
        self._spinning.start()

    def join_spinning(self) -> None:
        """Stop the executor and join its thread; a thread that spins at exit aborts the process.

        Only destroy nodes afterwards: see `DestructionLimit`. The application may call it in its
        teardown before it destroys nodes itself.
        """
        self._spinning.stop()
        if self.stopping:
            self._destruction.start(self.exit_code)

    def destroy_nodes(self) -> None:
        """Stop the executor and destroy its nodes, unless a callback hangs.

        A node that is not destroyed before the process exits is freed while DDS threads still use
        it, which sometimes causes a segmentation fault.
        """
        from arm_node.executor_thread import is_spinning

        nodes = self.executor.get_nodes()  # Before the shutdown, which removes them.
        self.join_spinning()
        if not is_spinning():
            for node in nodes:
                node.destroy_node()
        self._destruction.cancel()


Application = Callable[[NodeProcess], AbstractContextManager[None]]
"""Creates the nodes before it yields, tears them down afterwards; runs in the main thread."""


def run_process(
    application: Application,
    argv: Sequence[str] | None = None,
    user_errors: tuple[type[Exception], ...] = (),
    packages: Sequence[str] = (),
) -> int:
    """Run an application until SIGINT, SIGTERM, SIGHUP or its own `stop`; return the exit code.

    If SIGHUP is ignored, as under nohup, it stays ignored. If ROS cannot start in this environment,
    one sentence goes to stderr and the exit code is 2.

    Args:
        application: creates the nodes, see `Application`.
        argv: ROS arguments of the process, after the program's name; default sys.argv.
        user_errors: errors with messages for the user: one FATAL line, no traceback, exit code 1.
            Refusals by rclpy (a parameter's type, a name, a topic with two types) are handled the
            same way.
        packages: further interface packages that it needs, see `prepare_environment`.
    """
    # Objects made at the start stay alive: collecting them repeatedly would cost start-up time, and
    # later cause a pause in the middle of a control period.
    gc.disable()
    # NumPy's library for linear algebra would start a thread for each processor, and let them spin
    # between its first tasks. A robot's matrices are too small for more than one.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Before the imports below, which take some tenths of a second, so that Ctrl-C works now.
    with _signals_set(StopEvent()) as stop:
        try:
            prepare_environment(packages=packages)
            use_local_profile(os.environ)
        except UnusableEnvironmentError as error:
            sys.stderr.write(f"{printable_message(str(error))}\n")
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
    words = list(sys.argv if argv is None else argv)
    try:
        # rcl opens the files by itself: a FIFO blocks it for ever.
        for flag, file in pairwise(words):
            if flag in FILE_ARGUMENTS:
                check_file(file, MAX_TEXT_BYTES)
        with made_private():  # The log file.
            rclpy.init(args=words, signal_handler_options=SignalHandlerOptions.NO)
    except OSError as error:
        problem = printable(f"cannot read {error.filename}: {error.strerror}")
        sys.stderr.write(f"cannot start ROS: {problem}\n")
        return EXIT_USAGE
    except rclpy_implementation.UnknownROSArgsError as error:
        unknown = printable(str(error))
        sys.stderr.write(f"cannot start ROS: unknown arguments after --ros-args: {unknown}\n")
        return EXIT_USAGE
    except Exception as error:
        # rcl raises half a dozen unrelated types here, all caused by the given arguments.
        sys.stderr.write(f"cannot start ROS: {printable(first_line(error))}\n")
        return EXIT_USAGE
    try:
        exit_code = _run_initialised(application, user_errors, stop)
    finally:
        try_shutdown()
    _leave_hanging_callbacks(exit_code)
    if exit_code != EXIT_OK:
        # A node that failed during construction is not in the executor, but is kept by reference
        # cycles.
        gc.collect()
    return exit_code


def _leave_hanging_callbacks(exit_code: int) -> None:
    """Exit immediately if a callback does not return.

    Python's own teardown would end the callback's thread as soon as it returns from rclpy, inside
    C++ code, which aborts the process.
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
    from arm_node.ros_logging import bridge_logging
    from arm_node.workarounds.parameter_types import refuse_unknown_parameter_types

    refuse_unknown_parameter_types()
    # rclpy's second message about an invalid node name; the first one is logged below.
    warnings.filterwarnings("ignore", "Failed to fini rosout publisher", RuntimeWarning)
    process = NodeProcess(stop)
    with bridge_logging():
        if off := switched_off():
            logging.getLogger("arm_node").info("%s", off)
        try:
            with application(process):
                hide_shared_memory()
                process.start_spinning()
                gc.freeze()
                gc.enable()
                notify("READY=1")
                process.wait()
                notify("STOPPING=1")
        except (ParameterValueError, *user_errors) as error:
            _logger_of(error, process).critical("%s", error)
            process.stop(EXIT_FAILED)
        except _refusals() as error:
            _logger_of(error, process).critical("cannot create the node: %s", first_line(error))
            process.stop(EXIT_FAILED)
        finally:
            process.destroy_nodes()
    return process.exit_code


def _logger_of(error: Exception, process: NodeProcess) -> logging.Logger:
    """Return the logger of the node whose code raised, or else of the process's first node.

    A node that could not be made has a name, too, which users look for in the log.
    """
    from rclpy.node import Node

    frames = traceback.walk_tb(error.__traceback__)
    raising = [frame.f_locals.get("self") for frame, _ in frames]
    named = (
        node.get_logger().name
        for node in (*raising, *process.executor.get_nodes())
        if isinstance(node, Node) and hasattr(node, "_logger")
    )
    return logging.getLogger(next(named, "arm_node"))


def _refusals() -> tuple[type[Exception], ...]:
    """Return the exceptions of rclpy for invalid parameters, names and topics."""
    from rclpy.exceptions import NameValidationException, ParameterException
    from rclpy.qos_overriding_options import InvalidQosOverridesError

    # rcl's own refusals and invalid QoS policies are RuntimeErrors.
    return (ParameterException, NameValidationException, InvalidQosOverridesError, RuntimeError)


@contextmanager
def _signals_set(stop: StopEvent) -> Iterator[StopEvent]:
    """Make the terminating signals set an event and do nothing else."""

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
