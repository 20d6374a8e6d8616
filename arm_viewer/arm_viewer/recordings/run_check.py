"""Recordings of runs: told apart from bags, and verified by running them again.

`arm sim replay` simulates the run in a process of its own, compares each control period with the
recording, and writes those that are equal as a bag, file by file. The page plays the files that are
complete while it goes on.
"""

import json
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from arm_viewer.errors import PageRecordingError

SUFFIX = ".run"
MAGIC = b"\x89MCAP0\r\n"
PROFILE = b"arm-run"
_PROFILE_OFFSET = len(MAGIC) + 13
"""After the magic come opcode (1 byte) and length (8) of the header, and the profile's (4)."""
_MAX_SAID = 500


def is_run(path: Path) -> bool:
    """Return whether a file is a recording of a run; its name does not matter."""
    try:
        with path.open("rb") as stream:
            head = stream.read(_PROFILE_OFFSET + len(PROFILE))
    except OSError:
        return False
    return head.startswith(MAGIC) and head[_PROFILE_OFFSET:] == PROFILE


@dataclass(frozen=True, slots=True)
class RunVerdict:
    """What is known about a run that is being verified, or was.

    Attributes:
        name: of its file.
        text: a sentence about it.
        details: what else is to say, a line each.
        differences: what ran again otherwise, and what was recorded instead, a line each.
        is_over: whether it has run again, or cannot.
        is_equal: whether every period of the recording has run again, and is equal.
        compared_s: how far it has been compared, and is equal, from its beginning.
        length_s: its length; 0 as long as it is not known.
        differs_s: the end of the first period that differs; None if none is known.
    """

    name: str
    text: str = "it is being read"
    details: tuple[str, ...] = ()
    differences: tuple[str, ...] = ()
    is_over: bool = False
    is_equal: bool = False
    compared_s: float = 0.0
    length_s: float = 0.0
    differs_s: float | None = None


@dataclass(frozen=True, slots=True)
class EqualPart:
    """The beginning of a run that is equal and can be shown.

    Attributes:
        files: of the bag that shows it.
        until_s: where it ends.
        grows: whether there may be more.
    """

    files: tuple[Path, ...] = ()
    until_s: float = 0.0
    grows: bool = True


class RunCheck:
    """Runs a recording again in a process; any thread may call its methods.

    Attributes:
        verdict: what is known so far.
        part: what can be shown so far.
    """

    def __init__(
        self,
        path: Path,
        changed: Callable[["RunCheck"], None],
        command: Sequence[str] = (sys.executable, "-P", "-m", "arm_cli", "sim", "replay"),
    ) -> None:
        """Begin; `changed` is called in another thread when there is more to show, and at the end.

        Raises:
            PageRecordingError: the process cannot be started.
        """
        self.verdict = RunVerdict(path.name)
        self.part = EqualPart()
        self._result: RunVerdict | None = None
        self._changed = changed
        self._folder = tempfile.TemporaryDirectory(
            prefix="arm_page_run_", ignore_cleanup_errors=True
        )
        self._bag = Path(self._folder.name) / path.name
        self._is_wanted = True
        words = [*command, "--json", "--bag", str(self._bag), str(path.absolute())]
        try:
            self._process = subprocess.Popen(
                words,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                errors="replace",
                start_new_session=True,
            )
        except OSError as error:
            self._folder.cleanup()
            raise PageRecordingError(f"cannot start {words[0]}: {error.strerror}") from error
        self._said: list[str] = []
        self._listener = threading.Thread(target=self._listen, name="run check", daemon=True)
        self._listener.start()
        # The last to start, because it waits for the other at the end of the process.
        threading.Thread(target=self._follow, name="run check", daemon=True).start()

    def close(self) -> str:
        """End the process, and remove its bag; say what was not compared, if anything was not."""
        verdict, self._is_wanted = self.verdict, False
        self._process.kill()
        self._folder.cleanup()
        if verdict.is_over:
            return ""
        if not verdict.compared_s:
            return f"{verdict.name}: verification stopped before anything was compared"
        return (
            f"{verdict.name}: verification stopped; 0 to {_range(verdict)} is equal, the rest was "
            "not compared"
        )

    def fail(self, why: str) -> None:
        """Say that the run cannot be run again any further."""
        before = (
            f"0 to {_range(self.verdict)} is equal, then it " if self.verdict.compared_s else ""
        )
        text = f"{before}cannot be run again: {why}"
        self.verdict = replace(self.verdict, text=text, is_over=True, is_equal=False)

    def _listen(self) -> None:
        """Keep the last words of stderr."""
        assert self._process.stderr is not None
        with self._process.stderr as lines:
            for line in lines:
                self._said = [*self._said, line.strip()[:_MAX_SAID]][-4:]

    def _follow(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as lines:
            for line in lines:
                shown = self.part
                self._take(line)
                if self.part is not shown and self._is_wanted:
                    self._changed(self)
        code = self._process.wait()
        self._listener.join()
        if not self._is_wanted:
            return
        self.part = replace(self.part, grows=False)
        if code >= 0:
            # It has finished its last file.
            files = tuple(self._bag.glob("*.mcap"))
            self.part = EqualPart(files, self.verdict.compared_s, grows=False)
        self._changed(self)
        # Only now, because whoever sees that it is over may go to its end at once.
        if self.verdict.is_over:
            return
        if self._result is None:
            self.fail(" ".join(self._said) or "the process ended without a word")
        else:
            self.verdict = self._result

    def _take(self, line: str) -> None:
        try:
            told = json.loads(line)
            if "result" in told:
                self._result = _result(self.verdict.name, told["result"], self._said)
                self.verdict = replace(
                    self.verdict,
                    compared_s=self._result.compared_s,
                    length_s=self._result.length_s,
                )
            else:
                self._take_progress(told)
        except (ValueError, KeyError, TypeError):
            self._said = [*self._said, line.strip()[:_MAX_SAID]][-4:]

    def _take_progress(self, told: Mapping[str, Any]) -> None:
        compared_s, length_s = (told[key] * told["period_s"] for key in _LENGTHS)
        verdict = replace(self.verdict, compared_s=compared_s, length_s=length_s)
        text = f"equal so far: {_range(verdict)}"
        self.verdict = replace(verdict, text=text)
        if "file" in told:
            files = (*self.part.files, self._bag / told["file"])
            self.part = EqualPart(files, compared_s)


_LENGTHS = ("periods", "of_periods")


def _range(verdict: RunVerdict) -> str:
    return f"{verdict.compared_s:.2f} of {verdict.length_s:.2f} s"


def _result(name: str, found: Mapping[str, Any], said: Sequence[str]) -> RunVerdict:
    periods, difference = found["periods"], found["difference"]
    period_s = found["period_s"]
    details = list(said)
    if found["is_cut_off"]:
        details.append("the recording has no end: its writer was killed, or is still writing")
    if found["end_reason"]:
        details.append(f"the recording ended because {found['end_reason']}")
    verdict = RunVerdict(
        name,
        is_over=True,
        is_equal=difference is None and periods > 0,
        compared_s=periods * period_s,
        length_s=found["of_periods"] * period_s,
    )
    if difference is None:
        text = (
            f"verified: all {periods} control periods are equal"
            if periods
            else "holds no control period, so nothing was compared"
        )
        return replace(verdict, text=text, details=tuple(details))
    differs_s = verdict.compared_s + period_s
    text = (
        f"differs at {differs_s:.2f} s, in control period {difference['period']}: "
        f"{difference['lines'][0]}"
    )
    details = (
        *details,
        f"0 to {_range(verdict)} is equal; what follows is neither compared nor shown",
    )
    lines = tuple(difference["lines"])
    return replace(verdict, text=text, details=details, differences=lines, differs_s=differs_s)
