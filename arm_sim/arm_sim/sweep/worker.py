"""A process that makes the runs of a study, one after the other."""

import math
import os
import signal
import time
import traceback
from collections.abc import Mapping
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from shlex import quote
from typing import Any

from arm_sim.sweep.journal import Outcome
from arm_sim.sweep.study import Run, StudyError, Value, Values, find_task

RECORDING = "run_{number}.run"


def run_seed(study_seed: int, number: int) -> int:
    """Return a seed for a run; two runs, and the runs of two studies, have different ones."""
    return study_seed * 1_000_003 + number


def work(connection: Connection, task: str, study_seed: int, folder: Path) -> None:
    """Serve a study until the connection ends; the entry of the process.

    Args:
        connection: gives (number, values), and takes outcomes.
        task: see `Study`.
        study_seed: the seed of the study.
        folder: where the recordings of failed runs go.
    """
    # Ctrl-C is for the process that owns the study; it ends this one.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        function = find_task(task)
    except StudyError as error:
        connection.send(error)
        return
    # The connection fails where the process that owns the study was killed.
    with suppress(EOFError, OSError):
        connection.send(os.getpid())
        while True:
            number, values = connection.recv()
            connection.send(_outcome(function, number, values, study_seed, folder))


def _outcome(function: Any, number: int, values: Values, study_seed: int, folder: Path) -> Outcome:
    seed = run_seed(study_seed, number)
    began_s = time.monotonic()
    results, error = _attempt(function, Run(number, values, seed))
    if not error:
        return Outcome(number, values, results, wall_s=time.monotonic() - began_s)
    # The same run fails again, for it has the same seed; this time it is recorded.
    path = folder / RECORDING.format(number=number)
    path.unlink(missing_ok=True)
    _attempt(function, Run(number, values, seed, path))
    replay = f"arm sim replay {quote(str(path))}" if path.exists() else ""
    return Outcome(number, values, {}, error, replay, time.monotonic() - began_s)


def _attempt(function: Any, run: Run) -> tuple[dict[str, Value], str]:
    """Return the results of a run, or why it failed."""
    try:
        return _checked(function(run)), ""
    except Exception as error:
        # A task is the user's code and may raise anything.
        place = traceback.extract_tb(error.__traceback__)[-1]
        where = f"{Path(place.filename).name}:{place.lineno}"
        return {}, f"{type(error).__name__}: {' '.join(str(error).split())} ({where})"
    finally:
        run.close()


def _checked(results: object) -> dict[str, Value]:
    """Return the results as plain values.

    Raises:
        StudyError: they are not a mapping of numbers and texts, or a number is not finite.
    """
    if not isinstance(results, Mapping):
        raise StudyError(f"the task must return a mapping of results, not {results!r}")
    checked: dict[str, Value] = {}
    for name, value in results.items():
        plain = value.item() if hasattr(value, "item") else value
        if not isinstance(plain, (bool, int, float, str)):
            raise StudyError(f"result '{name}' must be a number or a text, not {value!r}")
        if isinstance(plain, float) and not math.isfinite(plain):
            raise StudyError(f"result '{name}' is {plain}, which is not a finite number")
        checked[str(name)] = plain
    return checked
