"""The outcomes of a study as tables: CSV, and Parquet where pyarrow is installed."""

import csv
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from arm_sim.sweep.journal import Outcome

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
