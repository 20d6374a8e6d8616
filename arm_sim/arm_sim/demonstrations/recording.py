"""Records demonstrations: workers make them, one process writes them in the order of seeds."""

import multiprocessing
import os
import signal
import time
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from itertools import count
from pathlib import Path
from typing import Protocol

from arm_gazebo.errors import GazeboError
from arm_gazebo.feed.child_process import end_with_parent
from arm_sim.dataset import DatasetWriter, align, check_dataset
from arm_sim.demonstrations.pick import ROBOT, TASK, Demonstration, PickDemonstrator
from arm_sim.errors import ArmSimError

FAILURES_ALLOWED = 10
"""Recording ends without a dataset after more failures than this, and than episodes wanted."""


class Awaited(Protocol):
    """A demonstration that has been started, such as a future."""

    def result(self) -> Demonstration:
        """Wait for it, and return it."""
        ...


Making = Callable[[int], Awaited]
"""Starts the demonstration of a seed."""


class DemonstrationError(ArmSimError):
    """Demonstrations could not be made; the message says why."""


@dataclass(frozen=True, slots=True)
class RecordedDemonstrations:
    """What was recorded.

    Attributes:
        episodes: how many the dataset has.
        failures: why the expert failed, by the seeds that were left out.
        processor_s: processor time for each episode, with its share of failures and writing.
    """

    episodes: int
    failures: dict[int, str]
    processor_s: float


@cache
def _demonstrator() -> PickDemonstrator:
    # A process keeps its simulation for the next seed.
    return PickDemonstrator()


def make_demonstration(seed: int) -> Demonstration:
    """Make the demonstration of a seed with this process's simulation."""
    return _demonstrator().make(seed)


def show_now(seed: int) -> "Future[Demonstration]":
    """Make the demonstration of a seed in this process."""
    made: Future[Demonstration] = Future()
    made.set_result(make_demonstration(seed))
    return made


def record_demonstrations(
    output: Path,
    episodes: int,
    start: Making = show_now,
    *,
    seed: int = 0,
    ahead: int = 1,
    task: str = TASK,
    robot: str = ROBOT,
    say: Callable[[str], None] = lambda sentence: None,
    enough: Callable[[], bool] = lambda: False,
) -> RecordedDemonstrations:
    """Write the first episodes in which the expert succeeds, in the order of their seeds.

    The same seed and number of episodes give the same data, whoever makes them.

    Args:
        output: the folder to create.
        episodes: how many, at least 1.
        start: starts the demonstration of a seed; by default it is made at once, here.
        seed: seed of the first episode; each further one has the next.
        ahead: how many are started before the first has ended.
        task: what the demonstrations show, as a sentence.
        robot: name of the robot.
        say: gets a sentence for each episode.
        enough: whether to end with the episodes so far; asked after each one.

    Raises:
        DemonstrationError: the expert fails too often, or a worker has ended.
        CallError: the folder exists.
    """
    failures: dict[int, str] = {}
    started: deque[Awaited] = deque()
    seeds = count(seed)
    began_s, made_s, written = time.process_time(), 0.0, 0
    with DatasetWriter(output, robot) as writer:
        while written < episodes and not (written and enough()):
            while len(started) < min(ahead, episodes - written):
                started.append(start(next(seeds)))
            shown = _result(started.popleft())
            made_s += shown.processor_s
            if shown.failure:
                failures[shown.seed] = shown.failure
                say(f"seed {shown.seed}: left out, {shown.failure}")
                _check_failures(failures, episodes)
                continue
            streams = shown.streams()
            source = {"expert": "pick", "seed": shown.seed, "scene": shown.scene}
            writer.add_episode(streams, align(streams, 0), task, source)
            written += 1
            say(f"seed {shown.seed}: episode {written} of {episodes}")
        writer.finish()
    if faults := check_dataset(output):
        raise DemonstrationError(f"{output} was written, but {faults[0]}")
    spent_s = made_s + time.process_time() - began_s
    return RecordedDemonstrations(written, failures, spent_s / written)


def _check_failures(failures: dict[int, str], episodes: int) -> None:
    if len(failures) > max(FAILURES_ALLOWED, episodes):
        last = next(reversed(failures))
        raise DemonstrationError(
            f"the expert failed in {len(failures)} episodes, which is too often; no dataset is "
            f"written. The last failure, of seed {last}: {failures[last]}"
        )


def _result(made: Awaited) -> Demonstration:
    try:
        return made.result()
    except BrokenProcessPool as error:
        raise DemonstrationError("a process that makes demonstrations has ended") from error
    except GazeboError as error:
        raise DemonstrationError(str(error)) from error


@contextmanager
def worker_processes(number: int) -> Iterator[Making]:
    """Give what starts demonstrations in processes, which end with the context, at once."""
    # Spawned: a forked process would share what OpenGL and threads have begun.
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(number, context, initializer=_begin, initargs=(os.getpid(),))
    try:
        yield lambda seed: pool.submit(make_demonstration, seed)
    finally:
        # What they still make is not wanted. From Python 3.14 on this is `terminate_workers`.
        for worker in list(pool._processes.values()):  # pyright: ignore[reportPrivateUsage]
            worker.terminate()
        pool.shutdown(cancel_futures=True)


def _begin(parent: int) -> None:
    """Leave Ctrl-C to the process that writes, and end with it, however it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    end_with_parent(parent)
