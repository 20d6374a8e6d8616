"""Shows what is live, or a recording: the one place that decides which of both the page sees.

While a recording is shown, nothing that a user does reaches a robot but the emergency stop.
"""

import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from arm_viewer.errors import PageRecordingError
from arm_viewer.recordings.marks import Mark
from arm_viewer.recordings.open_recording import (
    OpenRecording,
    PlayerState,
    StateReader,
    Wanted,
)
from arm_viewer.recordings.playback import Playback
from arm_viewer.recordings.recorded_bag import RecordedBag
from arm_viewer.recordings.run_check import RunCheck, is_run
from arm_viewer.requests import (
    ListNumbers,
    LookAtThing,
    MeasureRates,
    PlotCurves,
    Request,
    Send,
    SetEmergencyStop,
    ShowContacts,
    ShowPictures,
    Watch,
)
from arm_viewer.snapshot import Snapshot

REFUSED = "This is a recording: go back to live to move or change anything"
_PASSED_ON = (
    *(Watch, ShowPictures, ShowContacts, PlotCurves, ListNumbers, MeasureRates, LookAtThing),
    SetEmergencyStop,
)


class Player:
    """Any thread may call its methods. A recording is read in a thread of its own."""

    def __init__(
        self,
        live: Callable[[], Snapshot],
        send: Send,
        make_reader: Callable[[RecordedBag], StateReader],
        check_run: Callable[[Path, Callable[[RunCheck], None]], RunCheck] = RunCheck,
    ) -> None:
        """Begin live; `send` takes the requests for robots, `check_run` begins to verify a run."""
        self._live = live
        self._send = send
        self._make_reader = make_reader
        self._wanted = Wanted()
        self._check_run = check_run
        self._shown: OpenRecording | None = None
        self._check: RunCheck | None = None
        self._stopped = ""
        self._change = threading.Lock()
        self.refusals = 0
        """How many requests were refused because they would have moved or changed a robot."""

    def latest(self) -> Snapshot:
        """Return the snapshot that the page shows."""
        live, shown = self._live(), self._shown
        if shown is None or shown.snapshot is None:
            return live
        return replace(shown.snapshot, stops=live.stops, control_answer=live.control_answer)

    def send(self, request: Request) -> None:
        """Pass a request on; while a recording is shown, only what moves no robot."""
        shown = self._shown
        if isinstance(request, ShowPictures | PlotCurves):
            if isinstance(request, ShowPictures):
                self._wanted = replace(self._wanted, pictures=request.topics)
            else:
                self._wanted = replace(self._wanted, curves=request.names)
            if shown is not None:
                shown.show(self._wanted)
        if shown is None or isinstance(request, _PASSED_ON):
            self._send(request)
        else:
            self.refusals += 1

    @property
    def state(self) -> PlayerState:
        """What is shown."""
        shown, check = self._shown, self._check
        state = PlayerState() if shown is None else shown.state
        verdict = None if check is None else check.verdict
        return replace(state, run=verdict, stopped=self._stopped)

    @property
    def problem(self) -> str:
        """Why the recording cannot be read any further; empty if it can."""
        shown = self._shown
        return "" if shown is None else shown.problem

    def open(self, path: Path) -> None:
        """Show a recording from its beginning; a run is shown as far as it has been verified.

        Raises:
            PageRecordingError: it cannot be read.
        """
        if is_run(path):
            self.close()
            with self._change:
                self._check = self._check_run(path, lambda check: self._show_run(path, check))
            return
        opened = OpenRecording(path, self._make_reader, self._wanted)
        self.close()
        self._shown = opened
        opened.start()

    def close(self) -> None:
        """Go back to what is live."""
        with self._change:
            shown, self._shown = self._shown, None
            check, self._check = self._check, None
        if shown is not None:
            shown.end()
        self._stopped = "" if check is None else check.close()

    def _show_run(self, path: Path, check: RunCheck) -> None:
        """Show what is equal so far of a run, unless something else is shown by now."""
        with self._change:
            part = check.part
            if not part.files or self._check is not check:
                return
            try:
                if self._shown is None:
                    length_s = check.verdict.length_s
                    shown = OpenRecording(path, self._make_reader, self._wanted, part, length_s)
                    shown.start()
                    self._shown = shown
                else:
                    self._shown.extend(part)
            except PageRecordingError as error:
                check.fail(str(error))

    def act(self, change: Callable[[Playback], None]) -> None:
        """Change the position or the speed of the recording.

        Raises:
            PageRecordingError: no recording is shown.
        """
        self._opened().act(change)

    def show_curve(self, topic: str, number: str) -> None:
        """Read the curve of a number; raises PageRecordingError if there is no such number."""
        self._opened().show_curve(topic, number)

    def set_marks(self, change: Callable[[tuple[Mark, ...]], tuple[Mark, ...]]) -> None:
        """Change the marks and write them; raises PageRecordingError if they cannot be written."""
        self._opened().set_marks(change)

    def _opened(self) -> OpenRecording:
        shown = self._shown
        if shown is None:
            raise PageRecordingError("no recording is open")
        return shown
