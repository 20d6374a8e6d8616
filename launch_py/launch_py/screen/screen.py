"""The screens: plain lines for files, pipes and CI; a panel and a status line on a terminal."""

from __future__ import annotations

import itertools
import os
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, TextIO

Rows = tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class ReadySummary:
    """The summary shown when everything is ready; its rows are pairs of label and text."""

    title: str
    topics: Rows
    commands: Rows
    notes: Rows


class Screen(Protocol):
    """Shows the output. Every method may raise OSError if its stream is closed."""

    def begin(self, names: Sequence[str], status: Callable[[], str]) -> None:
        """Take the names of the processes and the function that returns the status."""
        ...

    def line(self, name: str, text: str) -> None:
        """Show a line that a process has written."""
        ...

    def note(self, text: str) -> None:
        """Show a message of the supervisor."""
        ...

    def problem(self, text: str) -> None:
        """Show a problem."""
        ...

    def ready(self, elapsed_s: float, summary: ReadySummary) -> None:
        """Show that everything is ready."""
        ...

    def refresh(self) -> None:
        """Replace the status line by the current status."""
        ...

    def end(self, text: str, failed: bool) -> None:
        """Show the last line."""
        ...


OWN_NAME = "launch"


class PlainScreen:
    """Writes `[name] text`, without boxes, colours or a status line."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def begin(self, names: Sequence[str], status: Callable[[], str]) -> None:
        """Do nothing: plain lines are not aligned."""

    def line(self, name: str, text: str) -> None:
        """Show a line that a process has written."""
        self._stream.write(f"[{name}] {text}\n")
        self._stream.flush()

    def note(self, text: str) -> None:
        """Show a message of the supervisor."""
        self.line(OWN_NAME, text)

    def problem(self, text: str) -> None:
        """Show a problem."""
        self.line(OWN_NAME, text)

    def ready(self, elapsed_s: float, summary: ReadySummary) -> None:
        """Show the summary, and in the last line the time until everything was ready."""
        for label, text in (*summary.topics, *summary.commands, *summary.notes):
            self.note(f"{label}: {text}")
        self._stream.write(f"ready {elapsed_s:.2f} s\n")
        self._stream.flush()

    def refresh(self) -> None:
        """Do nothing: a plain stream cannot replace a status line."""

    def end(self, text: str, failed: bool) -> None:
        """Show the last line."""
        self.note(text)


MAX_NAME_WIDTH = 24
COLOURS = ("36", "32", "33", "35", "34", "96", "92", "93", "95", "94")
BOLD, DIM, RED, GREEN = "1", "2", "31", "32"
ERASE_LINE = "\r\x1b[2K"


class TerminalScreen:
    """Shows the output on a terminal.

    Lines and the status line are written by hand, because rich takes a millisecond per line and
    100 ms to import. It draws the panel only, once everything runs.

    Args:
        stream: the terminal.
        started_s: the time of `clock` at which the launch began.
        colours: false if the user has set NO_COLOR.
        clock: gives the time in seconds.
    """

    def __init__(
        self,
        stream: TextIO,
        started_s: float,
        colours: bool,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._stream = stream
        self._started_s = started_s
        self._colours = colours
        self._clock = clock
        self._status: Callable[[], str] | None = None
        self._width = len(OWN_NAME)
        self._colour_of: dict[str, str] = {OWN_NAME: BOLD}
        self._next_colour = itertools.cycle(COLOURS)

    def begin(self, names: Sequence[str], status: Callable[[], str]) -> None:
        """Align the prefixes for these names and start to show the status line."""
        self._status = status
        longest = max((len(name) for name in names), default=0)
        self._width = min(max(longest, len(OWN_NAME)), MAX_NAME_WIDTH)

    def line(self, name: str, text: str) -> None:
        """Show a line that a process has written."""
        if name not in self._colour_of:
            self._colour_of[name] = next(self._next_colour)
        elapsed = self._paint(DIM, f"{self._clock() - self._started_s:7.2f}")
        label = self._paint(self._colour_of[name], f"{name[: self._width]:<{self._width}}")
        reset = "\x1b[0m" if "\x1b" in text else ""
        self._write(f"{elapsed} {label} │ {text}{reset}\n")

    def note(self, text: str) -> None:
        """Show a message of the supervisor."""
        self.line(OWN_NAME, text)

    def problem(self, text: str) -> None:
        """Show a problem."""
        self.line(OWN_NAME, self._paint(RED, text))

    def ready(self, elapsed_s: float, summary: ReadySummary) -> None:
        """Show the panel, and below it the commands, without a box so that they can be copied."""
        from rich.console import Console
        from rich.panel import Panel
        from rich.table import Table
        from rich.text import Text

        table = Table.grid(padding=(0, 2))
        table.add_column(no_wrap=True)
        table.add_column(overflow="fold")  # A path must not be cut off.
        for label, text in summary.topics:
            table.add_row(Text(label, "cyan"), Text(text))
        for label, text in summary.notes:
            table.add_row(Text(label, "dim"), Text(text))
        title = Text(f" {summary.title}: ready in {elapsed_s:.2f} s ", style="bold green")
        self._write("", keep_status=False)
        colours = "standard" if self._colours else None
        console = Console(
            file=self._stream, force_terminal=True, color_system=colours, highlight=False
        )
        console.print(Panel(table, title=title, title_align="left", border_style="green"))
        for label, text in summary.commands:
            self._write(f"  {self._paint(DIM, label)}\n    {self._paint(BOLD, text)}\n")
        self._write("")

    def refresh(self) -> None:
        """Show the current status below everything else."""
        self._write("")

    def end(self, text: str, failed: bool) -> None:
        """Remove the status line and show the last line."""
        self._status = None
        self.line(OWN_NAME, self._paint(RED if failed else GREEN, text))

    def _write(self, text: str, keep_status: bool = True) -> None:
        """Write lines above the status line, in a single write to avoid flicker."""
        status = ""
        if keep_status and self._status is not None:
            status = self._paint(DIM, self._status()[: _columns(self._stream) - 1])
        self._stream.write(f"{ERASE_LINE}{text}{status}")
        self._stream.flush()

    def _paint(self, code: str, text: str) -> str:
        return f"\x1b[{code}m{text}\x1b[0m" if self._colours else text


def _columns(stream: TextIO) -> int:
    try:
        return os.get_terminal_size(stream.fileno()).columns or 80
    except (OSError, ValueError):
        return 80
