"""Workers that are actors of a Ray cluster: processes on its machines."""

import atexit
import logging
import math
import os
import sys
import time
from collections.abc import Iterable, Mapping
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from queue import Empty, SimpleQueue
from tempfile import TemporaryDirectory
from threading import Thread
from typing import Any

from arm_gazebo.state.made_with import made_with
from arm_sim.errors import MissingPackageError
from arm_sim.sweep.journal import Outcome
from arm_sim.sweep.pool import WorkerLostError
from arm_sim.sweep.ray_head import HeadWatch, check_address
from arm_sim.sweep.study import Study, StudyError, Values, find_task
from arm_sim.sweep.task_run import recording_path, replay_command, run_once

try:
    import ray
except ModuleNotFoundError as error:
    if error.name != "ray":
        raise
    raise MissingPackageError("Ray", "ray") from error

from ray.exceptions import RayError, RayTaskError

AUTO = "auto"
PATIENCE_S = 120.0
"""How long the cluster may have no worker that has started."""
SIZE_EVERY_S = 2.0
SAME_VERSIONS = ("arm-suite", "mujoco", "numpy", "python")


class RayPool:
    """Starts workers on a Ray cluster, one for each of its processors.

    This machine must be one of the cluster. The folder of the study's task is sent to the others,
    and is the working directory there.

    Args:
        address: HOST:PORT of the cluster's head, or AUTO for the cluster of this machine.
        study: the study.
        folder: where the recordings of failed runs go, on this machine.
        most: the most workers at once; None for one for each processor.

    Raises:
        StudyError: there is no cluster at that address, or it cannot be used.
    """

    attempts = 3
    """A machine that goes takes runs with it that did nothing wrong."""

    def __init__(self, address: str, study: Study, folder: Path, most: int | None = None) -> None:
        file, _, function = study.task.rpartition(":")
        self._most = most or math.inf
        self._address = join(address, _sent(Path(file).parent, folder.resolve()))
        self._actors: Any = ray.remote(_Maker).options(num_cpus=1)
        self._arguments = (Path(file).name, function, study.seed)
        self._news = _News(folder.absolute(), HeadWatch(self._address))
        self._none_since_s = time.monotonic()
        self._sized_s = -math.inf
        self._size = 0
        self._sizing = Thread()

    def size(self) -> int:
        """Return how many processors the cluster had lately, or the given limit; 0 at first.

        Raises:
            StudyError: the head of the cluster has gone.
        """
        self._news.head.check()
        if not self._news.head.answers():
            return 0
        if not self._sizing.is_alive() and time.monotonic() - self._sized_s > SIZE_EVERY_S:
            # In a thread of its own: the call waits for a head that goes meanwhile.
            self._sizing = Thread(target=self._ask_size, daemon=True)
            self._sizing.start()
        return self._size

    def _ask_size(self) -> None:
        with suppress(RayError):
            self._size = int(min(ray.cluster_resources().get("CPU", 0), self._most))
            self._sized_s = time.monotonic()

    def add(self) -> "_RayWorker":
        """Start a worker; the cluster does so as soon as one of its processors is free."""
        actor = self._actors.remote(*self._arguments)
        return _RayWorker(actor, self._news)

    def wait(self, timeout_s: float) -> Iterable["_RayWorker"]:
        """Return the workers that have sent something, or have ended.

        Raises:
            StudyError: the cluster has had no worker for PATIENCE_S.
        """
        now_s = time.monotonic()
        if self._news.started:
            self._none_since_s = now_s
        elif now_s - self._none_since_s > PATIENCE_S:
            raise StudyError(
                f"the Ray cluster at {self._address} has started no process within "
                f"{PATIENCE_S:g} s: {self._news.loss or 'its processors are busy'}; "
                f"`ray status --address {self._address}` shows it"
            )
        sent: list[_RayWorker] = []
        with suppress(Empty):
            sent.append(self._news.sent.get(timeout=timeout_s))
            while True:
                sent.append(self._news.sent.get_nowait())
        return sent

    def close(self) -> None:
        """Leave the cluster, which ends all workers."""
        if self._sizing.is_alive() and self._news.head.answers(looks_now=True):
            self._sizing.join()
        leave(self._news.head)


def join(address: str, environment: Mapping[str, Any]) -> str:
    """Make this process a driver of a cluster; return the address of its head.

    Args:
        address: see `RayPool`.
        environment: Ray's `runtime_env` of its processes.

    Raises:
        StudyError: see `RayPool`.
    """
    if address != AUTO:
        check_address(address)
    try:
        ray.init(
            address=address,
            runtime_env=dict(environment),
            log_to_driver=False,
            logging_level=logging.ERROR,
        )
        return ray.get_runtime_context().gcs_address
    except (RayError, RuntimeError, OSError, ValueError) as error:
        raise StudyError(f"cannot join the Ray cluster at {address}: {sentence(error)}") from error


def leave(head: HeadWatch) -> None:
    """Leave the cluster, which ends what this process has started there."""
    if head.answers(looks_now=True):
        ray.shutdown()
    else:
        atexit.register(_exit_at_once)


def check_versions(machine: str, made: Mapping[str, str]) -> None:
    """Check that a machine has the versions of this one, as `made_with` gives them.

    Raises:
        StudyError: it has others.
    """
    here = made_with()
    differences = [
        f"{name} {made.get(name)} (here {here[name]})"
        for name in SAME_VERSIONS
        if made.get(name) != here[name]
    ]
    if differences:
        raise StudyError(
            f"{machine} of the Ray cluster has other versions: {', '.join(differences)}; "
            "install the same on all its machines"
        )


def _sent(folder: Path, output: Path) -> Mapping[str, Any]:
    """Return the environment to which a folder is sent, without that of the results in it."""
    excluded = [f"/{output.relative_to(folder)}"] if folder in output.parents else []
    return {"working_dir": str(folder), "excludes": excluded}


@dataclass
class _News:
    """What the workers tell their pool.

    Attributes:
        folder: where recordings of failed runs go.
        head: the head of the cluster. Ray's calls wait for one that has gone, and end this process
            after a minute.
        sent: the workers that have something to receive.
        started: those that can make runs.
        loss: why a worker was lost that had not started; the last one.
    """

    folder: Path
    head: HeadWatch
    sent: "SimpleQueue[_RayWorker]" = field(default_factory=SimpleQueue)
    started: "set[_RayWorker]" = field(default_factory=set)
    loss: str = ""


class _RayWorker:
    """An actor of the cluster, by the handle of its `_Maker`."""

    def __init__(self, actor: Any, news: _News) -> None:
        self._actor = actor
        self._news = news
        self._machine = "the cluster"
        self._await(actor.start.remote())

    def give(self, number: int, values: Values) -> None:
        self._await(self._actor.make.remote(number, values))

    def receive(self) -> Outcome | None:
        try:
            answer = self._answer.result()
        except RayError as error:
            # A failure of `_Maker` itself, which catches those of the user's task.
            if isinstance(error, RayTaskError) or getattr(error, "actor_init_failed", False):
                raise StudyError(
                    f"a process of the Ray cluster cannot make runs: {last_line(error)}; install "
                    "the same arm-suite on all its machines"
                ) from error
            if self not in self._news.started:
                self._news.loss = sentence(error)
            # It may be unreachable and alive; no result of it counts any more.
            self.kill()
            reason = f"its process on {self._machine} was lost ({type(error).__name__})"
            raise WorkerLostError(reason) from error
        if self not in self._news.started:
            self._start(*answer)
            return None
        outcome, recording = answer
        if not recording:
            return outcome
        path = recording_path(self._news.folder, outcome.number)
        path.write_bytes(recording)
        return replace(outcome, replay=replay_command(path))

    def end(self) -> None:
        self._news.started.discard(self)
        self._actor.__ray_terminate__.remote()

    def kill(self) -> None:
        self._news.started.discard(self)
        if self._news.head.answers(looks_now=True):
            ray.kill(self._actor)

    def _await(self, reference: Any) -> None:
        self._answer: Future[Any] = reference.future()
        # Ray's thread calls it.
        self._answer.add_done_callback(lambda _: self._news.sent.put(self))

    def _start(self, machine: str, made: Mapping[str, str], error: StudyError | None) -> None:
        check_versions(machine, made)
        if error is not None:
            raise error
        self._machine = machine
        self._news.started.add(self)


class _Maker:
    """Makes runs in a process of the cluster, whose working directory has the task's file."""

    def __init__(self, file: str, function: str, study_seed: int) -> None:
        self._task_name = f"{Path.cwd() / file}:{function}"
        self._study_seed = study_seed

    def start(self) -> tuple[str, Mapping[str, str], StudyError | None]:
        """Load the task; return the machine's address, its versions, and why it cannot be run."""
        error = None
        try:
            self._task = find_task(self._task_name)
        except StudyError as failure:
            error = failure
        return ray.util.get_node_ip_address(), made_with(), error

    def make(self, number: int, values: Values) -> tuple[Outcome, bytes]:
        """Make a run; return what came of it, and its recording; b"" if there is none."""
        with TemporaryDirectory() as name:
            outcome = run_once(self._task, number, values, self._study_seed, Path(name))
            return outcome, recording_path(
                Path(name), number
            ).read_bytes() if outcome.replay else b""


def _exit_at_once() -> None:
    """End this process. Without the head Ray would wait for a minute at Python's exit, or crash."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(1)


def sentence(error: Exception) -> str:
    """Return the message of one of Ray's errors on one line."""
    return " ".join(str(error).split())


def last_line(error: Exception) -> str:
    """Return what ends the traceback in one of Ray's errors."""
    return str(error).strip().splitlines()[-1].strip()
