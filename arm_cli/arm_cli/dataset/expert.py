"""`arm dataset record --expert`: an expert demonstrates its task in simulations of its own."""

import argparse
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

from arm_cli.arguments import Argument, Group, positive_whole_number, whole_number
from arm_cli.errors import ArmCliError
from arm_cli.output import complain, say

if TYPE_CHECKING:
    from arm_sim.demonstrations.recording import Making

EXPERTS = ("pick",)
OF_EXPERTS = ("seed", "workers", "ray")
"""The options that a recording of a running robot does not have."""
OF_RECORDINGS = ("duration", "state", "action", "cameras", "fps")
"""The options that an expert does not have."""
ENDING = b"ends after this episode with those so far; Ctrl-C again discards all of them\n"

EXPERT = Group(
    "experts",
    Argument(
        "--expert",
        choices=EXPERTS,
        help="instead of recording a running robot, let an expert demonstrate its task in random "
        "scenes; pick: the myCobot lifts a cylinder",
    ),
    Argument(
        "--seed",
        type=whole_number,
        metavar="N",
        help="seed of the first episode (default 0); each further one has the next",
    ),
    Argument(
        "--workers",
        type=positive_whole_number,
        metavar="N",
        help="processes that make episodes (default: one for each core)",
    ),
    Argument(
        "--ray",
        metavar="ADDRESS",
        help="make the episodes on the Ray cluster whose head has this address: HOST:PORT, or auto "
        "for the cluster of this machine",
    ),
)
"""The options of experts."""


def show(options: argparse.Namespace, output: Path) -> None:
    """Let an expert make a dataset; say in which episodes it failed.

    Raises:
        ArmCliError: an option does not fit, an extra is not installed, or the dataset cannot be
            written.
    """
    given = [f"--{name}" for name in OF_RECORDINGS if getattr(options, name) is not None]
    if given:
        raise ArmCliError(f"{given[0]} is for the recording of a running robot, not for --expert")
    from arm_sim.errors import ArmSimError

    words = {"task": options.task, "robot": options.robot}
    try:
        from arm_sim.demonstrations import record_demonstrations

        with _ctrl_c() as was_pressed, _workers(options) as (start, workers):
            recorded = record_demonstrations(
                output,
                options.episodes,
                start,
                seed=options.seed or 0,
                # One more than there are workers, so that none waits for the writing.
                ahead=workers + 1,
                say=complain,
                enough=was_pressed,
                **{name: text for name, text in words.items() if text is not None},
            )
    except (ArmSimError, OSError) as error:
        raise ArmCliError(str(error)) from error
    say(
        f"wrote {output}: {recorded.episodes} episodes, each in {recorded.processor_s:.1f} s of "
        "processor time"
    )
    if recorded.failures:
        tried = recorded.episodes + len(recorded.failures)
        seeds = ", ".join(map(str, recorded.failures))
        say(f"the expert failed in {len(recorded.failures)} of {tried}, left out: seeds {seeds}")


@contextmanager
def _ctrl_c() -> Iterator[Callable[[], bool]]:
    """Give whether Ctrl-C was pressed; pressed again, it interrupts at once."""
    pressed = False

    def note(number: int, frame: FrameType | None) -> None:
        nonlocal pressed
        if pressed:
            signal.default_int_handler(number, frame)
        pressed = True
        # Not by `print`, which this may have interrupted.
        os.write(2, ENDING)

    before = signal.getsignal(signal.SIGINT)
    if before is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, note)
    try:
        yield lambda: pressed
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def _workers(options: argparse.Namespace) -> "Iterator[tuple[Making, int]]":
    """Give what starts episodes, and how many it makes at once."""
    if options.ray is not None:
        from arm_sim.demonstrations.ray_workers import ray_workers

        with ray_workers(options.ray, options.workers) as started:
            yield started
        return
    from arm_sim.demonstrations import worker_processes

    number = options.workers or len(os.sched_getaffinity(0))
    with worker_processes(number) as start:
        yield start, number
