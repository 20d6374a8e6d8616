"""What a study is: a task, what varies, and how the variations are drawn."""

import hashlib
import importlib.util
import itertools
import json
import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from arm_sim.errors import ArmSimError

if TYPE_CHECKING:
    from arm_sim.simulation import Simulation

Value = bool | int | float | str
Values = Mapping[str, Value]

SAMPLINGS = ("grid", "random", "latin_hypercube")
KEYS = ("task", "sampling", "samples", "seed", "timeout_s", "variations")
MAX_RUNS = 10_000_000


class StudyError(ArmSimError):
    """A study cannot be read or run; the message says why."""


@dataclass(frozen=True, slots=True)
class Range:
    """A variation between two numbers.

    Attributes:
        low: the least value.
        high: the greatest value.
        is_whole: whether values are whole numbers, both ends included.
    """

    low: float
    high: float
    is_whole: bool = False

    def at(self, share: float) -> Value:
        """Return the value at a share of the range, from 0 to 1."""
        if self.is_whole:
            count = int(self.high) - int(self.low) + 1
            return int(self.low) + min(int(share * count), count - 1)
        return self.low + share * (self.high - self.low)


Variation = Range | tuple[Value, ...]


@dataclass(frozen=True, slots=True)
class Study:
    """A study.

    Attributes:
        task: 'FILE.py:FUNCTION', absolute. The function takes a `Run` and returns a mapping of
            results: numbers and texts.
        variations: by name.
        sampling: one of SAMPLINGS; grid takes every combination of listed values.
        samples: number of runs, but for a grid.
        seed: of the samples; each run has a seed of its own that follows from it.
        timeout_s: wall time after which a run has failed.
    """

    task: str
    variations: Mapping[str, Variation]
    sampling: str = "grid"
    samples: int = 0
    seed: int = 0
    timeout_s: float = math.inf

    @property
    def digest(self) -> str:
        """A hash of everything that decides what the runs are."""
        text = json.dumps([self.sampling, self.samples, self.seed, repr(dict(self.variations))])
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    def runs(self) -> list[dict[str, Value]]:
        """Return the values of each run, in their order."""
        names = list(self.variations)
        if self.sampling == "grid":
            lists: list[Sequence[Value]] = [_listed(self.variations[name]) for name in names]
            return [dict(zip(names, row, strict=True)) for row in itertools.product(*lists)]
        shares = self._shares(len(names))
        return [
            {
                name: _pick(self.variations[name], share)
                for name, share in zip(names, row, strict=True)
            }
            for row in shares.tolist()
        ]

    def _shares(self, columns: int) -> np.ndarray:
        """Return the samples in the unit cube, shape (samples, columns)."""
        random = np.random.default_rng(self.seed)
        inside = random.random((self.samples, columns))
        if self.sampling == "random":
            return inside
        # A Latin hypercube: each variation has one sample in each of `samples` equal parts.
        parts = np.stack([random.permutation(self.samples) for _ in range(columns)], axis=1)
        return (parts + inside) / self.samples


@dataclass(frozen=True, slots=True)
class Run:
    """One run of a study, as its task gets it.

    Attributes:
        number: counted from 0.
        values: the values of the variations.
        seed: a seed of its own.
        recording: file to record to; None for no recording.
    """

    number: int
    values: Values
    seed: int
    recording: Path | None = None
    _made: "list[Simulation]" = field(default_factory=list, compare=False)

    def simulation(self, description: str = "arm", **arguments: Any) -> "Simulation":
        """Return a `Simulation` with the run's seed; the run closes it.

        A run that fails is repeated with a recording of the first simulation that it makes.
        """
        # Here: a process whose task simulates nothing starts in half the time.
        from arm_sim.simulation import Simulation

        given: dict[str, Any] = {"seed": self.seed, **arguments}
        if self.recording is not None and not self._made:
            given["record"] = self.recording
        sim = Simulation(description, **given)
        self._made.append(sim)
        return sim

    def close(self) -> None:
        """Close the simulations."""
        while self._made:
            self._made.pop().close()


TaskFunction = Callable[[Run], Mapping[str, Value]]
"""Makes a run; returns its results."""


def read_study(path: Path) -> Study:
    """Return the study of a YAML file, or of a Python file that has a mapping `STUDY`.

    Raises:
        StudyError: the file cannot be read, or is not a study.
    """
    if not path.is_file():
        raise StudyError(f"{path} {'is not a file' if path.exists() else 'does not exist'}")
    if path.suffix == ".py":
        given = getattr(load_module(path), "STUDY", None)
        if given is None:
            raise StudyError(f"{path} has no mapping named STUDY")
    else:
        given = _read_yaml(path)
    return _study(given, path)


def load_module(path: Path) -> Any:
    """Import a file as a module of its own.

    Raises:
        StudyError: it cannot be imported.
    """
    name = f"arm_study_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise StudyError(f"{path} is not a Python file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        # An import runs the user's code, which may raise anything.
        raise StudyError(f"{path} cannot be imported: {type(error).__name__}: {error}") from error
    return module


def find_task(task: str) -> TaskFunction:
    """Return the function that 'FILE.py:FUNCTION' names.

    Raises:
        StudyError: there is none.
    """
    file, _, name = task.rpartition(":")
    function: Any = getattr(load_module(Path(file)), name, None)
    if callable(function):
        return cast(TaskFunction, function)
    raise StudyError(f"{file} has no function '{name}'")


def _read_yaml(path: Path) -> Any:
    from arm_node.limited_yaml import load_yaml

    try:
        return load_yaml(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise StudyError(f"{path}: {' '.join(str(error).split())}") from error


def _study(given: Any, path: Path) -> Study:
    if not isinstance(given, Mapping):
        raise StudyError(f"{path} is not a mapping with the keys {', '.join(KEYS)}")
    unknown = sorted(set(map(str, given)) - set(KEYS))
    if unknown:
        raise StudyError(f"{path}: unknown {', '.join(unknown)}; the keys are {', '.join(KEYS)}")
    variations = given.get("variations")
    if not isinstance(variations, Mapping) or not variations:
        raise StudyError(f"{path}: variations must be a mapping of names to values")
    sampling = str(given.get("sampling", "grid"))
    if sampling not in SAMPLINGS:
        raise StudyError(f"{path}: sampling '{sampling}' is not one of {', '.join(SAMPLINGS)}")
    study = Study(
        _task(given.get("task"), path),
        {str(name): _variation(str(name), spec, path) for name, spec in variations.items()},
        sampling,
        _whole(given, "samples", 0, path),
        _whole(given, "seed", 0, path),
        _timeout_s(given, path),
    )
    if sampling == "grid":
        count = math.prod(len(_listed(v, path)) for v in study.variations.values())
    else:
        count = study.samples
    if not 0 < count <= MAX_RUNS:
        raise StudyError(f"{path}: {count} runs; a study has 1 to {MAX_RUNS}")
    return study


def _task(text: Any, path: Path) -> str:
    file, _, name = str(text or "").rpartition(":")
    if not name.isidentifier():
        raise StudyError(f"{path}: task must be FILE.py:FUNCTION, not {text!r}")
    return f"{(path.parent / file).resolve() if file else path.resolve()}:{name}"


def _whole(given: Mapping[str, Any], key: str, default: int, path: Path) -> int:
    value = given.get(key, default)
    if not isinstance(value, int) or isinstance(value, bool) or value < 0:
        raise StudyError(f"{path}: {key} must be a whole number of at least 0, not {value!r}")
    return value


def _timeout_s(given: Mapping[str, Any], path: Path) -> float:
    value = given.get("timeout_s", math.inf)
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not value > 0:
        raise StudyError(f"{path}: timeout_s must be a positive number, not {value!r}")
    return float(value)


def _variation(name: str, spec: Any, path: Path) -> Variation:
    match spec:
        case [_, *_] if all(isinstance(value, (bool, int, float, str)) for value in spec):
            return tuple(spec)
        case {"from": int() | float() as low, "to": int() | float() as high, **rest}:
            whole = rest.pop("whole", False)
            is_fit = -math.inf < low <= high < math.inf and isinstance(whole, bool)
            if is_fit and not rest and (not whole or (int(low) == low and int(high) == high)):
                return Range(float(low), float(high), whole)
        case _:
            pass
    raise StudyError(
        f"{path}: variation '{name}' must be a list of values, or {{from: LOW, to: HIGH}}, with "
        "whole: true for whole numbers"
    )


def _listed(variation: Variation, path: Path | None = None) -> Sequence[Value]:
    if isinstance(variation, tuple):
        return variation
    if variation.is_whole:
        return range(int(variation.low), int(variation.high) + 1)
    where = f"{path}: " if path else ""
    raise StudyError(
        f"{where}a grid needs lists or whole numbers; it cannot list a range of real numbers"
    )


def _pick(variation: Variation, share: float) -> Value:
    if isinstance(variation, tuple):
        return variation[min(int(share * len(variation)), len(variation) - 1)]
    return variation.at(share)
