"""Plain lines: for files, pipes, CI and containers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TextIO

from launch_py.screen.screen import ReadySummary

OWN_NAME = "launch"


class PlainScreen:
    """Writes `[name] text`; no boxes, no colours, nothing that moves."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def begin(self, names: Sequence[str], status: Callable[[], str]) -> None:
        """Do nothing: plain lines are not aligned."""

    def line(self, name: str, text: str) -> None:
        """Show a line that a process has written."""
        self._stream.write(f"[{name}] {text}\n")
        self._stream.flush()

    def note(self, text: str) -> None:
        """Show something that the supervisor says."""
        self.line(OWN_NAME, text)

    def problem(self, text: str) -> None:
        """Show something that went wrong."""
        self.line(OWN_NAME, text)

    def ready(self, elapsed_s: float, summary: ReadySummary) -> None:
        """Show the summary; the last line says in how many seconds everything got ready."""
        for label, text in (*summary.topics, *summary.commands, *summary.notes):
            self.note(f"{label}: {text}")
        self._stream.write(f"ready {elapsed_s:.2f} s\n")
        self._stream.flush()

    def refresh(self) -> None:
        """Do nothing: a status that cannot be replaced would only pile up."""

    def end(self, text: str, failed: bool) -> None:
        """Show the last line."""
        self.note(text)
