"""The table has all rows, each with a line that is typed or a test that there is."""

import ast
from functools import cache
from pathlib import Path

import pytest
from originals_table import PAGES, read_parts, table_page

ROOT = Path(__file__).parents[2]
ROWS = [row for part in read_parts() for row in part.rows]
STEPS = [(row.name, step) for row in ROWS for step in row.steps]
NOT_RUN = {"skip", "skipif", "xfail"}


@cache
def names_of_tests(file: str) -> frozenset[str]:
    """Return the names of a file's tests that are run wherever the suite is."""
    functions = [n for n in ast.parse((ROOT / file).read_text()).body if hasattr(n, "name")]
    return frozenset(f.name for f in functions if NOT_RUN.isdisjoint(marks_of(f)))


def marks_of(function: ast.FunctionDef) -> set[str]:
    nodes = (node for mark in function.decorator_list for node in ast.walk(mark))
    return {node.attr for node in nodes if isinstance(node, ast.Attribute)}


def test_every_row_of_the_originals_is_there_once():
    assert sorted(row.name for row in ROWS) == [f"F{number:03}" for number in range(1, 146)]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.name)
def test_a_row_has_a_line_or_a_test_that_there_is(row):
    assert row.what
    assert row.steps or row.tests
    assert set(row.pages) <= set(PAGES)
    for test in row.tests:
        file, _, name = test.partition("::")
        assert name in names_of_tests(file), test


@pytest.mark.parametrize(("row", "step"), STEPS, ids=[f"{name}-{s.kind}" for name, s in STEPS])
def test_something_must_come_of_every_line(row, step):
    assert step.shows or step.reaches
    # What shows anything at all proves nothing.
    assert not any(set(line) <= {".", " "} for line in step.shows)


def test_the_page_shows_every_line_and_every_row():
    page = table_page()
    assert page.count("\n| F") == len(ROWS)
    assert "arm launch arm_gazebo arm_gazebo.launch.py course:=S0</code>" in page
    # A bar in a line would be a column's end.
    rows = [line for line in page.splitlines() if line.startswith("| F")]
    assert {line.count("|") for line in rows} == {6}
