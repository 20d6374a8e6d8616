"""Says everything twice: on the screen and in the log files."""

from __future__ import annotations

from collections.abc import Callable

from launch_py.screen.plain_screen import OWN_NAME
from launch_py.screen.screen import ReadySummary, Screen
from launch_py.supervision.log_folder import LogFolder, reason


class Reporter:
    """Writes to the screen and to the log folder; belongs to the loop's thread.

    A screen that is gone (a closed pipe or terminal) is left alone from then on; the log files go
    on. Where they cannot be written, the screen goes on and says so.

    Args:
        screen: where the user looks.
        logs: the log folder.
        show_all: whether the screen also shows what is meant for the log files only.
    """

    def __init__(self, screen: Screen, logs: LogFolder, show_all: bool = False) -> None:
        self.screen_is_gone = False
        self._screen = screen
        self._logs = logs
        self._show_all = show_all
        self._logs_fail = False

    def begin(self, names: list[str], status: Callable[[], str]) -> None:
        """Announce the names of the processes, and how to ask for the status."""
        self._show(lambda: self._screen.begin(names, status))

    def line(self, name: str, text: str, shown: bool) -> None:
        """Report a line that a process has written."""
        self._log(name, text)
        if shown or self._show_all:
            self._show(lambda: self._screen.line(name, text))

    def note(self, text: str) -> None:
        """Report something that the supervisor says."""
        self._log(OWN_NAME, text)
        self._show(lambda: self._screen.note(text))

    def problem(self, text: str) -> None:
        """Report something that went wrong."""
        self._log(OWN_NAME, text)
        self._show(lambda: self._screen.problem(text))

    def detail(self, text: str) -> None:
        """Report something that only whoever looks for a fault wants to know."""
        self._log(OWN_NAME, text)
        if self._show_all:
            self._show(lambda: self._screen.note(text))

    def ready(self, elapsed_s: float, summary: ReadySummary) -> None:
        """Report that everything is ready."""
        self._log(OWN_NAME, f"ready {elapsed_s:.2f} s")
        self._show(lambda: self._screen.ready(elapsed_s, summary))

    def refresh(self) -> None:
        """Show how things stand now, on the screen only."""
        self._show(self._screen.refresh)

    def end(self, text: str, failed: bool) -> None:
        """Report the last line."""
        self._log(OWN_NAME, text)
        self._show(lambda: self._screen.end(text, failed))

    def _log(self, name: str, text: str) -> None:
        try:
            self._logs.write(name, text)
        except OSError as error:
            if not self._logs_fail:
                self._logs_fail = True
                what = f"lines are missing in the log files of {self._logs.path}: {reason(error)}"
                self._show(lambda: self._screen.problem(what))

    def _show(self, show: Callable[[], None]) -> None:
        if self.screen_is_gone:
            return
        try:
            show()
        except (OSError, ValueError):
            # A broken pipe, a terminal that has hung up, or a closed stream.
            self.screen_is_gone = True
