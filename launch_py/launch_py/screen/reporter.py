"""Reports the launcher's messages and the processes' output on the screen and in the log files."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

from launch_py.printable import printable_coloured
from launch_py.screen.log_folder import LogFolder, reason
from launch_py.screen.screen import OWN_NAME, ReadySummary, Screen

BURST = 400_000
"""How many characters of a process may be shown at once. Each line counts as LINE more."""

LINE = 200
RATE_PER_S = 100_000
"""How many characters per second may be shown on average: a few hundred lines."""

ENOUGH = BURST // 2
"""How much allowance must be free again after dropped lines. Below that, lines and counts of
dropped lines would alternate."""


@dataclass(slots=True)
class _Allowance:
    left: float
    at_s: float
    dropped: int = 0


class OutputRateLimiter:
    """Decides which lines of a process are shown, and counts the others."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._allowances: dict[str, _Allowance] = {}

    def admits(self, name: str, text: str) -> bool:
        """Return whether to show a process's next line, and count the line if not."""
        allowance = self._refilled(name)
        cost = LINE + len(text)
        if allowance.dropped or cost > allowance.left:
            allowance.dropped += 1
            return False
        allowance.left -= cost
        return True

    def counts(self, at_end: bool = False) -> Iterator[tuple[str, int]]:
        """Yield each process that may show lines again, and how many of its lines were dropped.

        At the end all counts are yielded.
        """
        for name in self._allowances:
            allowance = self._refilled(name)
            if allowance.dropped and (at_end or allowance.left >= ENOUGH):
                dropped, allowance.dropped = allowance.dropped, 0
                yield name, dropped

    def _refilled(self, name: str) -> _Allowance:
        now_s = self._clock()
        allowance = self._allowances.get(name)
        if allowance is None:
            allowance = self._allowances[name] = _Allowance(BURST, now_s)
        elapsed_s = now_s - allowance.at_s
        allowance.left = min(BURST, allowance.left + RATE_PER_S * elapsed_s)
        allowance.at_s = now_s
        return allowance


class Reporter:
    """Writes to the screen and to the log folder; belongs to the loop's thread.

    After the screen fails (a closed pipe or terminal), only the log files are written. If a file
    cannot be written, the screen says so once. If a process writes more than anyone can read, the
    screen shows the first lines and now and then the number of lines it dropped. `show_all` also
    shows output that otherwise goes to the log files only.
    """

    def __init__(
        self,
        screen: Screen,
        logs: LogFolder,
        show_all: bool = False,
        rate_limiter: OutputRateLimiter | None = None,
    ) -> None:
        self.screen_is_gone = False
        self._screen = screen
        self._logs = logs
        self._show_all = show_all
        self._rate_limiter = rate_limiter or OutputRateLimiter()
        self._logs_fail = False

    def begin(self, names: list[str], status: Callable[[], str]) -> None:
        """Tell the screen the names of the processes and the function that returns the status."""
        self._show(lambda: self._screen.begin(names, status))

    def line(self, name: str, text: str, shown: bool) -> None:
        """Report a line that a process has written."""
        self._log(name, text)
        if (shown or self._show_all) and self._rate_limiter.admits(name, text):
            safe = printable_coloured(text)
            self._show(lambda: self._screen.line(name, safe))

    def report_dropped(self, at_end: bool = False) -> None:
        """Show how many lines were dropped. Call it from time to time."""
        for name, count in self._rate_limiter.counts(at_end):
            lines = "1 line is" if count == 1 else f"{count} lines are"
            self.problem(f"{name}: {lines} not shown here; its log files have the last of them")

    def note(self, text: str) -> None:
        """Report a message of the supervisor."""
        for line in _lines(text):
            self._log(OWN_NAME, line)
            self._show(partial(self._screen.note, line))

    def problem(self, text: str) -> None:
        """Report a problem."""
        for line in _lines(text):
            self._log(OWN_NAME, line)
            self._show(partial(self._screen.problem, line))

    def detail(self, text: str) -> None:
        """Report a detail for debugging: in the log, and on the screen with -a or -d."""
        if self._show_all:
            self.note(text)
        else:
            for line in _lines(text):
                self._log(OWN_NAME, line)

    def ready(self, elapsed_s: float, summary: ReadySummary) -> None:
        """Report that everything is ready."""
        self._log(OWN_NAME, f"ready {elapsed_s:.2f} s")
        self._show(lambda: self._screen.ready(elapsed_s, summary))

    def refresh(self) -> None:
        """Update the status line; nothing is logged."""
        self._show(self._screen.refresh)

    def end(self, text: str, failed: bool) -> None:
        """Report the last line."""
        self.report_dropped(at_end=True)
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


def _lines(text: str) -> Iterator[str]:
    """Yield the lines of a message of the supervisor or a launch file, safe to show."""
    return map(printable_coloured, text.split("\n"))
