"""The interface of a screen, and the plain screen for files, pipes, CI and containers."""

from __future__ import annotations

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
