"""Parameters of the simulation's node that take effect while it runs; two start something."""

import logging
from collections.abc import Callable, Sequence
from concurrent.futures import TimeoutError as FutureTimeoutError
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_control.errors import LoopStoppedError
from arm_control.loop.control_loop import ControlLoop
from arm_gazebo.errors import FaultError, RecordingError
from arm_gazebo.faults.fault import USAGE, Fault, read_fault
from arm_gazebo.faults.injector import FaultInjector
from arm_gazebo.run.run import SimulationRun
from arm_node.parameter_values import ParameterValueError, read_parameter, read_texts
from arm_node.parameters import check_changes, declare, take_other_notations
from arm_node.setting import Setting

if TYPE_CHECKING:
    from arm_gazebo.recording.recorder import RunRecorder


def follow_setting(node: Node, setting: Setting, apply: Callable[[Any], object]) -> None:
    """Apply a setting each time a client sets its parameter.

    A value that the setting refuses is not set, and the client gets the reason. `apply` takes the
    new value on the thread of the node's executor.
    """

    def check(changed: Sequence[Parameter]) -> None:
        for parameter in changed:
            if parameter.name == setting.name:
                read_parameter(setting.name, parameter.value, setting.read)

    def take(changed: Sequence[Parameter]) -> None:
        for parameter in changed:
            if parameter.name == setting.name:
                apply(setting.adapt(setting.read(parameter.value)))

    check_changes(node, check, ParameterValueError)
    node.add_post_set_parameters_callback(take)


RECORD_RUN = "record_run"

logger = logging.getLogger(__name__)


class RunRecording:
    """Begins a recording when `record_run` is set to a file, and ends it when it is set to "".

    The parameter's callbacks run on the executor of its node, which waits for the loop. `path` is
    the parameter's first value; "" for no recording.

    Raises:
        RecordingError: the first recording cannot begin.
    """

    def __init__(self, node: Node, run: SimulationRun, path: str) -> None:
        self._node = node
        self._run = run
        self._recorder: RunRecorder | None = None
        if path:
            self._begin(path)
        check_changes(node, self._take, RecordingError, LoopStoppedError)

    def supervise(self) -> None:
        """End a recording whose file can no longer be written; it has logged why."""
        if self._recorder is not None and self._recorder.failure:
            self._node.set_parameters([Parameter(RECORD_RUN, Parameter.Type.STRING, "")])

    def close(self) -> None:
        """End the recording with the simulation, whose loop still runs."""
        # A failed loop records nothing more, and what it recorded has reached the file.
        with suppress(LoopStoppedError):
            self._end("the simulation ended")

    def _take(self, changed: Sequence[Parameter]) -> None:
        for parameter in changed:
            if parameter.name == RECORD_RUN:
                self._change(str(parameter.value))

    def _change(self, path: str) -> None:
        if not path:
            self._end()
        elif self._recorder is not None:
            raise RecordingError(
                f"a recording to {self._recorder.path} is still running; end it by setting "
                f"{RECORD_RUN} to ''"
            )
        else:
            self._begin(path)

    def _begin(self, path: str) -> None:
        # Imported here, because most runs are not recorded.
        from arm_gazebo.recording.recorder import RunRecorder

        self._recorder = RunRecorder.to_file(self._run, Path(path).expanduser().absolute())
        logger.info("recording the run to %s", self._recorder.path)

    def _end(self, reason: str = "") -> None:
        recorder, self._recorder = self._recorder, None
        if recorder is not None:
            recorder.end(reason)
            logger.info("recorded %d control periods to %s", recorder.periods, recorder.path)


FAULTS = "faults"
LOOP_TIMEOUT_S = 10.0

_KINDS = "; ".join(f"{kind.value} {words}" for kind, words in USAGE.items())
_read_names = partial(read_texts, wanted=f"a list of texts, each one of: {_KINDS}")


def declare_faults(node: Node) -> None:
    """Declare the parameter, without any faults."""
    declare(
        node,
        FAULTS,
        [],
        _read_names,
        "faults for tests; each lasts as long as it is listed",
        read_only=False,
    )


class FaultParameter:
    """Begins and ends faults when the parameter `faults` is set.

    Its value is the list of all requested faults, such as `['joint_stalled j0', 'slow_tick 0.02']`;
    see `arm_gazebo.faults.fault`. The callback runs on the executor of its node, which waits for
    the loop.
    """

    def __init__(self, node: Node, injector: FaultInjector, loop: ControlLoop) -> None:
        self._injector = injector
        self._loop = loop
        declare_faults(node)
        take_other_notations(node, FAULTS)
        check_changes(node, self._take, FaultError)

    def _take(self, changed: Sequence[Parameter]) -> None:
        try:
            for parameter in changed:
                if parameter.name == FAULTS:
                    wanted = [read_fault(text) for text in read_texts(list(parameter.value or ()))]
                    call = self._loop.call(lambda faults=wanted: self._change(faults))
                    call.result(LOOP_TIMEOUT_S)
        except (ParameterValueError, FaultError, LoopStoppedError) as error:
            raise FaultError(f"{FAULTS}: {error}") from error
        except FutureTimeoutError as error:
            reason = f"the simulation did not respond within {LOOP_TIMEOUT_S:g} s"
            raise FaultError(f"{FAULTS}: {reason}") from error

    def _change(self, wanted: Sequence[Fault]) -> None:
        """Begin and end faults so that those in the list remain, all or nothing. Loop thread."""
        injector = self._injector
        for fault in wanted:
            injector.check(fault)
        for fault in [fault for fault in injector.active if fault not in wanted]:
            injector.end(fault)
            logger.warning("fault ends: %s", fault)
        for fault in dict.fromkeys(wanted):
            if fault not in injector.active:
                logger.warning("fault begins: %s", fault)
                injector.begin(fault)
