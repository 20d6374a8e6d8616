"""Recordings of runs: told apart from bags, and verified by running them again.

`arm sim replay` simulates the run in a process of its own, compares each control period with the
recording, and writes what it sees as a bag, which the page plays like any other.
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
        details: what differs, or what else is to say, a line each.
        is_over: whether it has run again, or cannot.
        is_equal: whether every period that has run again is equal.
    """

    name: str
    text: str = "starting"
    details: tuple[str, ...] = ()
    is_over: bool = False
    is_equal: bool = True


class RunCheck:
    """Runs a recording again in a process; any thread may call its methods.

    Attributes:
        verdict: what is known so far.
    """

    def __init__(
        self,
        path: Path,
        ended: Callable[["RunCheck", Path | None], None],
        command: Sequence[str] = (sys.executable, "-P", "-m", "arm_cli", "sim", "replay"),
    ) -> None:
        """Begin.

        Args:
            path: the recording.
            ended: called in another thread with the bag, None if there is none.
            command: what runs it again.

        Raises:
            PageRecordingError: the process cannot be started.
        """
        self.verdict = RunVerdict(path.name)
        self._ended = ended
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
        self._threads = [
            threading.Thread(target=run, name="run check", daemon=True)
            for run in (self._follow, self._listen)
        ]
        for thread in self._threads:
            thread.start()

    def close(self) -> None:
        """End the process, and remove its bag."""
        self._is_wanted = False
        self._process.kill()
        self._folder.cleanup()

    def fail(self, why: str) -> None:
        """Say that the run cannot be shown."""
        text = f"cannot be run again: {why}"
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
                self._take(line)
        self._process.wait()
        self._threads[1].join()
        if not self._is_wanted:
            return
        if not self.verdict.is_over:
            self.fail(" ".join(self._said) or "the process ended without a word")
        self._ended(self, self._bag if self._bag.is_dir() else None)

    def _take(self, line: str) -> None:
        try:
            told = json.loads(line)
            if "result" in told:
                self.verdict = _result(self.verdict.name, told["result"], self._said)
            else:
                passed_s, length_s = (told[key] * told["period_s"] for key in _LENGTHS)
                text = f"running it again: equal so far, {passed_s:.1f} of {length_s:.1f} s"
                self.verdict = replace(self.verdict, text=text)
        except (ValueError, KeyError, TypeError):
            self._said = [*self._said, line.strip()[:_MAX_SAID]][-4:]


_LENGTHS = ("periods", "of_periods")


def _result(name: str, found: Mapping[str, Any], said: Sequence[str]) -> RunVerdict:
    periods, difference = found["periods"], found["difference"]
    passed_s = periods * found["period_s"]
    details = list(said)
    if found["is_cut_off"]:
        details.append("the recording has no end: its writer was killed, or is still writing")
    if found["end_reason"]:
        details.append(f"the recording ended because {found['end_reason']}")
    if difference is None:
        text = (
            f"verified: all {periods} control periods are equal"
            if periods
            else "holds no control period, so nothing was compared"
        )
        return RunVerdict(name, text, tuple(details), True, periods > 0)
    text = (
        f"differs at {passed_s + found['period_s']:.2f} s, in control period "
        f"{difference['period']}: {difference['lines'][0]}"
    )
    details = [*difference["lines"], *details, "nothing after the difference is shown"]
    return RunVerdict(name, text, tuple(details), True, False)
