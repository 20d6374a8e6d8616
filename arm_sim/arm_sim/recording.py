"""Records a run of the library; `arm sim replay` runs it again."""

from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

from arm_gazebo.recording.session import RunParts, begin_recording, end_recording
from arm_sim.assembly import SimulationParts

ResultT = TypeVar("ResultT")


class _ThisThread:
    """The loop of a program that runs the ticks itself."""

    is_this_thread = True

    def call(self, function: Callable[[], ResultT]) -> "Future[ResultT]":
        """Run a function now, because no tick is running."""
        future: Future[ResultT] = Future()
        try:
            future.set_result(function())
        except Exception as error:
            # The caller gets the exception from the future, as from a loop in a thread of its own.
            future.set_exception(error)
        return future


def run_parts(parts: SimulationParts) -> RunParts:
    """Return what a recording needs of a simulation."""
    return RunParts(
        parts.physics,
        parts.state,
        parts.tick,
        _ThisThread(),
        [(parts.robot, parts.settings.robots[0], parts.manager_settings)],
        parts.settings.hold_joints,
        parts.settings.position_proportional_gain,
        parts.settings.seed,
    )


@contextmanager
def recording(parts: SimulationParts, path: Path) -> Iterator[None]:
    """Record a simulation from now on to the end of the `with` block.

    Args:
        parts: the simulation.
        path: the file, which must not exist.

    Raises:
        RecordingError: the file cannot be written.
    """
    run = run_parts(parts)
    recorder = begin_recording(run, path)
    reason = "the program failed"
    try:
        yield
        reason = ""
    finally:
        end_recording(run, recorder, reason)
