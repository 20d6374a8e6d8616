"""What the supervisor asks of a screen."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

Rows = tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class ReadySummary:
    """What the user is told when everything is ready; pairs of label and text."""

    title: str
    topics: Rows
    commands: Rows
    notes: Rows


class Screen(Protocol):
    """Where the output goes. Every method may raise OSError when nobody reads any more."""

    def begin(self, names: Sequence[str], status: Callable[[], str]) -> None:
        """Learn the names of the processes whose lines will come, and how to ask for the status."""
        ...

    def line(self, name: str, text: str) -> None:
        """Show a line that a process has written."""
        ...

    def note(self, text: str) -> None:
        """Show something that the supervisor says."""
        ...

    def problem(self, text: str) -> None:
        """Show something that went wrong."""
        ...

    def ready(self, elapsed_s: float, summary: ReadySummary) -> None:
        """Show that everything is ready."""
        ...

    def refresh(self) -> None:
        """Show how things stand now, in place of what was shown before."""
        ...

    def end(self, text: str, failed: bool) -> None:
        """Show the last line."""
        ...
