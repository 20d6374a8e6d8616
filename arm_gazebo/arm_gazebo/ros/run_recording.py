"""Records the run by a parameter of the simulation's node."""

import logging
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_control.errors import LoopStoppedError
from arm_gazebo.errors import RecordingError
from arm_gazebo.run.run import SimulationRun

if TYPE_CHECKING:
    from arm_gazebo.recording.recorder import RunRecorder

PARAMETER = "record_run"

logger = logging.getLogger(__name__)


class RunRecording:
    """Begins a recording when `record_run` is set to a file, and ends it when it is set to "".

    The parameter's callbacks run on the executor of its node, which waits for the loop.

    Args:
        node: declares the parameter.
        run: the run to record.
        path: the parameter's first value; "" for no recording.

    Raises:
        RecordingError: the first recording cannot begin.
    """

    def __init__(self, node: Node, run: SimulationRun, path: str) -> None:
        self._node = node
        self._run = run
        self._recorder: RunRecorder | None = None
        if path:
            self._begin(path)
        node.add_on_set_parameters_callback(self._take)

    def supervise(self) -> None:
        """End a recording whose file can no longer be written; it has logged why."""
        if self._recorder is not None and self._recorder.failure:
            self._node.set_parameters([Parameter(PARAMETER, Parameter.Type.STRING, "")])

    def close(self) -> None:
        """End the recording with the simulation, whose loop still runs."""
        # A failed loop records nothing more, and what it recorded has reached the file.
        with suppress(LoopStoppedError):
            self._end("the simulation ended")

    def _take(self, changed: Sequence[Parameter]) -> SetParametersResult:
        try:
            for parameter in changed:
                if parameter.name == PARAMETER:
                    self._change(str(parameter.value))
        except (RecordingError, LoopStoppedError) as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _change(self, path: str) -> None:
        if not path:
            self._end()
        elif self._recorder is not None:
            raise RecordingError(
                f"a recording to {self._recorder.path} is still running; end it by setting "
                f"{PARAMETER} to ''"
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
