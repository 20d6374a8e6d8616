"""What the five originals do, row by row: the line to type here, and what comes.

`originals.yaml` has the rows, `tests/originals/` types their lines, and the manual's table is
written from them. `python docs/originals_table.py` prints it.
"""

import html
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

FILE = Path(__file__).with_name("originals.yaml")
PAGES = ("S0", "S1", "S2", "S3", "S4")
KINDS = ("look", "run", "keep", "beside")
INTERRUPT = "^C"
"""Among the lines that are shown: here the reader presses Ctrl-C."""
MARKDOWN_SIGNS = "|[]*"
"""What Markdown would read as its own within an HTML element."""
COURSE = "{course}"
"""Stands for the page in a line: course:=S0 on page S0."""


@dataclass(frozen=True, slots=True)
class Step:
    """A line, and what it must come to.

    Attributes:
        kind: `look` only reads, and may be repeated; `run` is typed once; `keep` goes on for the
            rows below, in place of what was kept before; `beside` goes on beside that.
        line: what the reader types.
        pages: the pages on which it stands.
        shows: lines of the output, in their order; `...` stands for any words, and at `^C` the
            reader presses Ctrl-C.
        exact: whether numbers in the output count.
        typed: what is typed at the program's prompt.
        reaches: where the joints are in the end, in rad or m.
        states: the topic of their states.
        code: the exit code.
        tests_add: words that tests put behind the line, such as a free port.
    """

    kind: str
    line: str
    pages: tuple[str, ...]
    shows: tuple[str, ...] = ()
    exact: bool = False
    typed: tuple[str, ...] = ()
    reaches: tuple[tuple[str, float], ...] = ()
    states: str = "/joint_states"
    code: int = 0
    tests_add: str = ""


@dataclass(frozen=True, slots=True)
class Row:
    """What an original does for its readers, and how it is done here.

    Attributes:
        name: F001 to F145.
        pages: the originals that have it.
        what: what it is, in the original.
        steps: the lines that do it here.
        comes: what comes, beside what the lines show; tests prove it.
        tests: the tests that do, as pytest names them, without parameters.
        missing: what is not here, and why.
    """

    name: str
    pages: tuple[str, ...]
    what: str
    steps: tuple[Step, ...]
    comes: str
    tests: tuple[str, ...]
    missing: str


@dataclass(frozen=True, slots=True)
class Part:
    """Rows about one thing."""

    title: str
    rows: tuple[Row, ...]


def read_parts() -> tuple[Part, ...]:
    """Return the table.

    Raises:
        ValueError: a row has what no row can have.
    """
    parts: dict[str, dict[str, Any]] = yaml.load(FILE.read_bytes(), yaml.CSafeLoader)
    return tuple(
        Part(title, tuple(_row(name, content) for name, content in rows.items()))
        for title, rows in parts.items()
    )


def _row(name: str, content: dict[str, Any]) -> Row:
    pages = tuple(content.pop("of").split())
    try:
        return Row(
            name=name,
            pages=pages,
            what=content.pop("what"),
            steps=tuple(_step(step, pages) for step in content.pop("steps", ())),
            comes=content.pop("comes", ""),
            tests=tuple(content.pop("tests", ())),
            missing=content.pop("missing", ""),
            **content,
        )
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"row {name}: {error}") from error


def _step(content: dict[str, Any], pages: Sequence[str]) -> Step:
    (kind,) = content.keys() & set(KINDS)
    rest = {name: value for name, value in content.items() if name not in (kind, "of")}
    for name in ("shows", "typed"):
        if name in rest:
            rest[name] = tuple(rest[name])
    if "reaches" in rest:
        rest["reaches"] = tuple(rest["reaches"].items())
    on = tuple(content["of"].split()) if "of" in content else tuple(pages)
    return Step(kind=kind, line=content[kind].strip(), pages=on, **rest)


def table_page() -> str:
    """Return the page of the manual."""
    lines = [
        "# The five originals",
        "",
        "What a reader of each original types, what to type here, and what comes. S0 to S2 are a",
        "homework on a 4-DOF arm by three authors, S3 is its ancestor in ROS 1, S4 are the",
        "tutorials of the myCobot 280 and the ROSMASTER X3. `tests/originals/` types every line of",
        "these tables over ROS, one page after the other, and checks what is printed and where the",
        "joints arrive. One number in the output stands for any other, and `...` for any words.",
        "Where a test of another folder proves a row, it is named.",
        "",
        "`course:=S0` is the course of page S0; on the other pages it is theirs.",
    ]
    for part in read_parts():
        lines += ["", f"## {part.title}", "", "| | page | in the original | type | what comes |"]
        lines += ["|---|---|---|---|---|", *(_table_row(row) for row in part.rows)]
    return "\n".join([*lines, ""])


def _table_row(row: Row) -> str:
    shown = list(dict.fromkeys(_code(step.line) for step in row.steps))
    comes = list(dict.fromkeys(cell for step in row.steps for cell in _outcome(step)))
    comes += [_text(text) for text in (row.comes, row.missing) if text]
    comes += [f"<small>{html.escape(test)}</small>" for test in row.tests]
    cells = (row.name, " ".join(row.pages), _text(row.what), "<br>".join(shown))
    return f"| {' | '.join(cells)} | {'<br>'.join(comes)} |"


def _outcome(step: Step) -> Iterator[str]:
    yield from (_code(line) for line in step.shows)
    if step.typed:
        yield "after typing " + ", then ".join(map(_code, step.typed))
    if step.reaches:
        yield "the joints arrive: " + ", ".join(f"{name} {value:g}" for name, value in step.reaches)
    if step.kind == "keep":
        yield "it runs on for the rows below"


def _text(text: str) -> str:
    """Return a sentence, with its code spans, for a cell."""
    parts = enumerate(text.split("`"))
    return "".join(_code(part) if number % 2 else html.escape(part) for number, part in parts)


def _code(text: str) -> str:
    escaped = html.escape(text.replace(COURSE, "S0"), quote=False)
    for sign in MARKDOWN_SIGNS:
        escaped = escaped.replace(sign, f"&#{ord(sign)};")
    return "<br>".join(f"<code>{line.strip()}</code>" for line in escaped.splitlines())


if __name__ == "__main__":
    print(table_page())  # noqa: T201
