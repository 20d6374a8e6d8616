"""Walks through the pages of the originals: types their lines, and looks at what comes."""

import re
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from originals_table import COURSE, INTERRUPT, Row, Step, read_parts
from shell import TIMEOUT_S, Running, comparable, ended, pattern

ROWS = tuple(row for part in read_parts() for row in part.rows)
ARRIVAL = "all(abs(dict(zip(m.name, m.position))[n] - q) < {within} for n, q in {wanted})"
OF_FILES = re.compile(
    r"arm (?:pkg (?!create)|interface )|ls |arm launch .* --(?:show-args|print)\b"
)
"""Lines that only look at what is installed: whatever runs, the same comes of them."""
WITHIN = 0.02
"""How near each joint must come, in rad or m."""
ARRIVAL_S = 120.0


def rows_of(*pages: str) -> list[tuple[str, Row]]:
    """Return the rows with lines on these pages: each page from its first to its last."""
    return [(page, row) for page in pages for row in ROWS if steps_on(page, row)]


def steps_on(page: str, row: Row) -> list[Step]:
    return [step for step in row.steps if page in step.pages]


def typed_line(step: Step, page: str) -> str:
    """Return what is typed on a page, with what tests add."""
    return f"{step.line.replace(COURSE, page)} {step.tests_add}".strip()


def not_shown(step: Step, output: str, *, interrupted: bool = True) -> str:
    """Return the first line that should be in an output after those before it, and is not."""
    printed = iter(comparable(output, step.exact).splitlines(keepends=True))
    for line in step.shows:
        if line == INTERRUPT:
            if not interrupted:
                break
            continue
        wanted = pattern([line], step.exact)
        if not any(wanted.fullmatch(one) for one in printed):
            return line
    return ""


class Walk:
    """A reader's terminals: what runs on in some of them, and one for the lines that end."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._kept: dict[str, Running] = {}
        self._looked: dict[str, tuple[int, str]] = {}
        self._read: dict[str, tuple[int, str]] = {}

    def assert_row(self, page: str, row: Row) -> None:
        """Do a row's lines, beside what the rows before it left running.

        Raises:
            AssertionError: something else came than the table says.
        """
        for step in steps_on(page, row):
            self._keep(page, kept_until(page, row, step))
            if step.kind in ("keep", "beside"):
                pass
            elif step.kind == "look":
                self._look(step, page)
            else:
                self._run(step, page)
            if step.reaches:
                self._wait_for_joints(step)

    def _keep(self, page: str, wanted: list[Step]) -> None:
        lines = [typed_line(step, page) for step in wanted]
        if list(self._kept) != lines[: len(self._kept)]:
            self.end()
        for step, line in list(zip(wanted, lines, strict=True))[len(self._kept) :]:
            self._looked.clear()
            self._kept[line] = running = Running(line, self._folder)
            self._wait_until_shown(step, running)

    def _look(self, step: Step, page: str) -> None:
        """Read until it shows what it should: what starts up may be discovered late."""
        line = typed_line(step, page)
        deadline = time.monotonic() + TIMEOUT_S
        looked = self._read if OF_FILES.match(line) else self._looked
        while True:
            if line not in looked:
                looked[line] = ended(line, self._folder)
            code, output = looked[line]
            missing = not_shown(step, output)
            if code == step.code and not missing:
                return
            del looked[line]
            what = f"{line}: exit code {code}, {missing!r} is missing"
            assert time.monotonic() < deadline, f"{what}:\n{output}"

    def _run(self, step: Step, page: str) -> None:
        line = typed_line(step, page)
        if step.typed or INTERRUPT in step.shows:
            code, output = self._at_a_terminal(line, step)
        else:
            code, output = ended(line, self._folder)
        missing = not_shown(step, output)
        assert not missing, f"{line}: no {missing!r}:\n{output}"
        assert code == step.code, f"{line}: exit code {code}:\n{output}"
        assert "Traceback" not in output, output

    def _at_a_terminal(self, line: str, step: Step) -> tuple[int, str]:
        running = Running(line, self._folder, terminal=bool(step.typed))
        try:
            for words in step.typed:
                running.wait_until_shown(["..."])
                running.type(f"{words}\n")
            if INTERRUPT in step.shows:
                self._wait_until_shown(step, running)
                if step.reaches:
                    self._wait_for_joints(step)
                running.interrupt()
            return running.wait(), running.output
        finally:
            running.close()

    def _wait_until_shown(self, step: Step, running: Running) -> None:
        running.wait_for(lambda output: not not_shown(step, output, interrupted=False), step.shows)

    def _wait_for_joints(self, step: Step) -> None:
        condition = ARRIVAL.format(wanted=list(step.reaches), within=WITHIN)
        line = f"arm topic echo {step.states} --once"
        code, output = ended(f'{line} --filter "{condition}" --timeout {ARRIVAL_S:g}', self._folder)
        if code != 0:
            now = ended(f"{line} --timeout {ARRIVAL_S:g}", self._folder)[1]
            pytest.fail(f"not at {step.reaches}: {output}\nbut:\n{now}")

    def end(self) -> None:
        """End all that runs."""
        for running in reversed(self._kept.values()):
            running.close()
        self._kept.clear()
        self._looked.clear()


def kept_until(page: str, row: Row, step: Step) -> list[Step]:
    """Return what a page has left running at a step, that step included."""
    kept: list[Step] = []
    for one in _steps_until(page, row, step):
        if one.kind == "keep":
            kept = [one]
        elif one.kind == "beside":
            kept.append(one)
    return kept


def _steps_until(page: str, row: Row, step: Step) -> Iterator[Step]:
    for one in ROWS:
        for each in steps_on(page, one):
            yield each
            if one is row and each is step:
                return
