"""Records bags and runs: a process of `arm` beside the page, which its messages do not slow."""

import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from arm_viewer.errors import PageRecordingError
from arm_viewer.recordings.folder import size_of
from arm_viewer.recordings.run_check import SUFFIX as RUN_SUFFIX

ENDED_EARLY = "Stopped before it began: nothing was recorded."
END_S = 30.0
"""How long a recorder may take to write what it still has."""
_DROPPED = re.compile(r"\((\d+) in all\)")
_LISTENS = ("Listening", "recording to")
_STOPPED = "Recording stopped"
_LAST_LINES = 4


@dataclass(frozen=True, slots=True)
class RecorderState:
    """What the recorder does, or did last.

    Attributes:
        path: the bag or run; None before the first one.
        is_recording: whether it records, or still writes the end.
        is_starting: whether it does not listen yet.
        seconds: since it was started, while it records.
        size_bytes: of its files.
        dropped: number of messages that were lost.
        said: how the last recording ended, in its own words; empty while it records.
    """

    path: Path | None = None
    is_recording: bool = False
    is_starting: bool = False
    seconds: float = 0.0
    size_bytes: int = 0
    dropped: int = 0
    said: str = ""


class Recorder:
    """Starts and stops one recording at a time; any thread may call its methods."""

    def __init__(
        self,
        folder: Path,
        command: Sequence[str] = (sys.executable, "-m", "arm_cli"),
        now_s: Callable[[], float] = time.monotonic,
    ) -> None:
        """Record into new folders and files in this folder.

        The command is `arm`, whose `bag record` and `sim record` go on until they get a SIGINT.
        """
        self.folder = folder
        self._command = command
        self._now_s = now_s
        self._lock = threading.Lock()
        self._process: subprocess.Popen[str] | None = None
        self._path: Path | None = None
        self._began_s = 0.0
        self._dropped = 0
        self._lines: list[str] = []
        self._listens = False
        self._said = ""

    @property
    def state(self) -> RecorderState:
        """What it does."""
        with self._lock:
            path, is_recording = self._path, self._process is not None
            seconds = self._now_s() - self._began_s if is_recording else 0.0
            dropped, said = self._dropped, self._said
            is_starting = is_recording and not self._listens
        size_bytes = 0 if path is None else size_of(path)
        return RecorderState(path, is_recording, is_starting, seconds, size_bytes, dropped, said)

    def start(self, topics: Sequence[str]) -> None:
        """Start to record topics into a bag; all topics if there are none.

        Raises:
            PageRecordingError: a recording is running, or none can be made here.
        """
        if wrong := next((topic for topic in topics if not topic.startswith("/")), None):
            raise PageRecordingError(f"'{wrong}' is not a topic's name, which begins with /")
        path = self._new_path()
        chosen = ["--topics", *topics] if topics else ["--all"]
        self._begin(path, "bag", "record", "-o", str(path), *chosen)

    def start_run(self) -> None:
        """Start to record the simulation's run.

        Raises:
            PageRecordingError: a recording is running, or none can be made here.
        """
        path = self._new_path(RUN_SUFFIX)
        self._begin(path, "sim", "record", str(path.absolute()))

    def _new_path(self, suffix: str = "") -> Path:
        return self.folder / (time.strftime("recording_%Y_%m_%d-%H_%M_%S") + suffix)

    def _begin(self, path: Path, *words: str) -> None:
        with self._lock:
            if self._process is not None:
                raise PageRecordingError("a recording is running: stop it first")
            if path.exists():
                raise PageRecordingError(f"{path} exists already")
            try:
                self._process = subprocess.Popen(
                    [*self._command, *words],
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.STDOUT,
                    text=True,
                    errors="replace",
                    # Ctrl-C at the page reaches it once, by `close`, and not twice.
                    start_new_session=True,
                )
            except OSError as error:
                program = self._command[0]
                raise PageRecordingError(f"cannot start {program}: {error.strerror}") from error
            self._path, self._began_s = path, self._now_s()
            self._dropped, self._lines, self._said, self._listens = 0, [], "", False
            process = self._process
        threading.Thread(target=self._follow, args=(process,), name="recorder", daemon=True).start()

    def stop(self) -> None:
        """End the recording; it goes on until it is written.

        Raises:
            PageRecordingError: no recording is running.
        """
        with self._lock:
            if self._process is None:
                raise PageRecordingError("no recording is running")
            self._process.send_signal(signal.SIGINT)

    def close(self) -> None:
        """End the recording, if there is one, and wait until it is written."""
        process = self._process
        if process is None:
            return
        process.send_signal(signal.SIGINT)
        try:
            process.wait(END_S)
        except subprocess.TimeoutExpired:
            process.kill()

    def _follow(self, process: "subprocess.Popen[str]") -> None:
        """Read what the recorder says until it ends."""
        if process.stdout is not None:
            with process.stdout as lines:
                for line in lines:
                    self._take(line.strip())
        process.wait()
        with self._lock:
            self._process = None
            self._said = " ".join(map(_sentence, self._lines[-_LAST_LINES:])) or ENDED_EARLY

    def _take(self, line: str) -> None:
        found = _DROPPED.search(line)
        with self._lock:
            if found is not None:
                self._dropped = int(found[1])
            is_beginning = line.startswith(_LISTENS)
            self._listens = self._listens or is_beginning
            if line == _STOPPED:
                # What comes after it sums the recording up.
                self._lines.clear()
            elif line and not is_beginning:
                self._lines.append(line)


def _sentence(line: str) -> str:
    return line if line.endswith((".", "!")) else f"{line}."
