"""Runs the task of a study once, in the same way on every kind of worker."""

import math
import time
import traceback
from collections.abc import Mapping
from pathlib import Path
from shlex import quote

from arm_sim.sweep.journal import Outcome
from arm_sim.sweep.study import Run, StudyError, TaskFunction, Value, Values


def run_seed(study_seed: int, number: int) -> int:
    """Return a seed for a run; two runs, and the runs of two studies, have different ones."""
    return study_seed * 1_000_003 + number


def recording_path(folder: Path, number: int) -> Path:
    """Return where in a folder the recording of a failed run lies."""
    return folder / f"run_{number}.run"


def replay_command(recording: Path) -> str:
    """Return the command that shows a recording; "" if there is none."""
    return f"arm sim replay {quote(str(recording))}" if recording.exists() else ""


def run_once(
    task: TaskFunction, number: int, values: Values, study_seed: int, folder: Path
) -> Outcome:
    """Run the task once; return what came of it, whatever the task does.

    The recording of a run that fails goes to the folder.
    """
    seed = run_seed(study_seed, number)
    began_s = time.monotonic()
    results, error = _attempt(task, Run(number, values, seed))
    if not error:
        return Outcome(number, values, results, wall_s=time.monotonic() - began_s)
    # The same run fails again, for it has the same seed; this time it is recorded.
    recording = recording_path(folder, number)
    recording.unlink(missing_ok=True)
    _attempt(task, Run(number, values, seed, recording))
    wall_s = time.monotonic() - began_s
    return Outcome(number, values, {}, error, replay_command(recording), wall_s)


def _attempt(task: TaskFunction, run: Run) -> tuple[dict[str, Value], str]:
    """Return the results of a run, or why it failed."""
    try:
        return _checked(task(run)), ""
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
