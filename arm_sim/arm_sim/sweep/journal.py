"""The results of a study's runs, appended as they come, so that a kill loses none; their tables."""

import csv
import json
import os
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Self, TextIO

from arm_sim.sweep.study import Study, StudyError, Value, Values

FILE_NAME = "runs.jsonl"


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of a run.

    Attributes:
        number: the run's number.
        values: its values.
        results: what its task returned; empty if it failed.
        error: why it failed; "" if it did not.
        replay: the command that runs a failed run again; "" if there is none.
        wall_s: how long it took.
    """

    number: int
    values: Values
    results: Mapping[str, Value]
    error: str = ""
    replay: str = ""
    wall_s: float = 0.0


class Journal:
    """Appends outcomes to a file in a study's folder; a context manager. One process.

    Args:
        folder: the folder; it is made if it does not exist.
        study: the study; a folder with the runs of another one is refused.

    Raises:
        StudyError: the folder cannot be used.

    Attributes:
        outcomes: those of earlier sessions and of this one, by number of their run.
    """

    def __init__(self, folder: Path, study: Study) -> None:
        self.folder = folder
        self.outcomes: dict[int, Outcome] = {}
        path = folder / FILE_NAME
        try:
            folder.mkdir(parents=True, exist_ok=True)
            is_new = not path.exists()
            if not is_new:
                self._read(path, study)
            self._file: TextIO = path.open("a", encoding="utf-8")
        except OSError as error:
            raise StudyError(f"cannot use the folder {folder}: {error.strerror}") from error
        if is_new:
            self._append({"study": study.digest})

    def add(self, outcome: Outcome) -> None:
        """Note what came of a run; it is in the file when this returns."""
        self.outcomes[outcome.number] = outcome
        self._append(asdict(outcome))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_raised: object) -> None:
        self._file.close()

    def _append(self, item: Mapping[str, Any]) -> None:
        self._file.write(json.dumps(item) + "\n")
        self._file.flush()

    def _read(self, path: Path, study: Study) -> None:
        content = path.read_bytes()
        items, length = _whole_items(content)
        found = items[0].get("study") if items else None
        if found != study.digest:
            raise StudyError(
                f"{path.parent} holds the runs of another study, or of this one before it was "
                "changed; choose another folder with --output"
            )
        for item in items[1:]:
            self.outcomes[int(item["number"])] = Outcome(**item)
        if length < len(content):
            # A kill in the middle of a line: what follows must not be glued to it. Cutting the end
            # off leaves the lines before it untouched, whenever this process is killed.
            os.truncate(path, length)


def _whole_items(content: bytes) -> tuple[list[dict[str, Any]], int]:
    """Return the items up to the first line that is not whole, and the length of their lines."""
    items: list[dict[str, Any]] = []
    length = 0
    for line in content.splitlines(keepends=True):
        try:
            item = json.loads(line)
        except ValueError:
            break
        if not isinstance(item, dict) or not line.endswith(b"\n"):
            break
        items.append(item)
        length += len(line)
    return items, length


CSV, PARQUET = "runs.csv", "runs.parquet"
ABOUT = ("error", "replay", "wall_s")


def write_tables(folder: Path, outcomes: Iterable[Outcome]) -> list[Path]:
    """Write the tables of all outcomes, in the order of their runs; return their paths."""
    ordered = sorted(outcomes, key=lambda outcome: outcome.number)
    values = list(dict.fromkeys(name for o in ordered for name in o.values))
    results = list(dict.fromkeys(name for o in ordered for name in o.results))
    # A result may have the name of a variation.
    columns = ["run", *values, *(f"result.{n}" if n in values else n for n in results), *ABOUT]
    rows = [
        [
            outcome.number,
            *(outcome.values.get(name) for name in values),
            *(outcome.results.get(name) for name in results),
            *(getattr(outcome, name) for name in ABOUT),
        ]
        for outcome in ordered
    ]
    written = [folder / CSV]
    with written[0].open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(rows)
    table = _arrow_table(columns, rows)
    if table is not None:
        import pyarrow.parquet

        written.append(folder / PARQUET)
        pyarrow.parquet.write_table(table, written[1])
    return written


def _arrow_table(columns: list[str], rows: list[list[Any]]) -> Any:
    """Return the rows as a table of Arrow; None without pyarrow."""
    try:
        import pyarrow
    except ImportError:
        return None
    arrays = {}
    for column, cells in zip(columns, zip(*rows, strict=True), strict=True):
        kinds = {type(cell) for cell in cells if cell is not None}
        is_mixed = len(kinds) > 1 and not kinds <= {int, float}
        # A column of several types is text.
        arrays[column] = [None if c is None else str(c) if is_mixed else c for c in cells]
    return pyarrow.table(arrays)
