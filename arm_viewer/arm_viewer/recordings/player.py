"""Shows what is live, or a recording: the one place that decides which of both the page sees.

While a recording is shown, nothing that a user does reaches a robot but the emergency stop.
"""

import logging
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import Protocol

from arm_viewer.errors import PageRecordingError
from arm_viewer.recordings.curve import NumberPlace, WholeCurve, read_curve
from arm_viewer.recordings.marks import Mark, read_marks, write_marks
from arm_viewer.recordings.playback import Playback
from arm_viewer.recordings.recorded_bag import RecordedBag
from arm_viewer.recordings.run_check import RunCheck, RunVerdict, is_run
from arm_viewer.requests import (
    ListNumbers,
    MeasureRates,
    PlotCurves,
    Request,
    Send,
    SetEmergencyStop,
    ShowPictures,
    Watch,
)
from arm_viewer.snapshot import Snapshot
from arm_viewer.world_requests import LookAtThing

TICK_S = 1.0 / 30.0
IDLE_S = 0.2
JUMP_S = 20.0
"""Shown time between two moments that do not follow each other: longer than charts reach back."""
REFUSED = "This is a recording: go back to live to move or change anything"
_PASSED_ON = (
    *(Watch, ShowPictures, PlotCurves, ListNumbers, MeasureRates, LookAtThing),
    SetEmergencyStop,
)


@dataclass(frozen=True, slots=True)
class Wanted:
    """What of a recording is shown: pictures of these topics, and these curves."""

    pictures: frozenset[str] = frozenset()
    curves: frozenset[str] = frozenset()


class StateReader(Protocol):
    """Makes snapshots of a recording."""

    def at(self, time_ns: int, now_s: float, speed: float, wanted: Wanted) -> Snapshot:
        """Return the state at a moment."""
        ...

    def numbers(self) -> Mapping[tuple[str, str], NumberPlace]:
        """Return where the numbers of its messages stand, by topic and name."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class ShownCurve:
    """The curve of a number over the whole recording; `curve` is None until it is read."""

    topic: str
    number: str
    curve: WholeCurve | None = None


@dataclass(frozen=True, slots=True)
class PlayerState:
    """What the player shows.

    Attributes:
        name: of the recording; empty while the page is live.
        began_ns: when the recording began, in ns since 1970.
        length_s: its length.
        time_s: the moment that is shown, from its beginning.
        is_playing: whether it plays.
        speed: recorded seconds a second.
        marks: its marks, in order.
        numbers: the numbers that have a curve, by topic.
        curve: the number whose curve is shown.
        run: what is known about the run that it is, or that is being verified while the page is
            live; None for a bag.
    """

    name: str = ""
    began_ns: int = 0
    length_s: float = 0.0
    time_s: float = 0.0
    is_playing: bool = False
    speed: float = 1.0
    marks: tuple[Mark, ...] = ()
    numbers: tuple[tuple[str, str], ...] = ()
    curve: ShownCurve | None = None
    run: RunVerdict | None = None


class Player:
    """Any thread may call its methods. A recording is read in a thread of its own."""

    def __init__(
        self,
        live: Callable[[], Snapshot],
        send: Send,
        make_reader: Callable[[RecordedBag], StateReader],
        check_run: Callable[[Path, Callable[[RunCheck, Path | None], None]], RunCheck] = RunCheck,
    ) -> None:
        """Begin live.

        Args:
            live: returns the newest live snapshot.
            send: takes the requests that go to the robots.
            make_reader: returns what reads the messages of a recording.
            check_run: begins to verify a recording of a run.
        """
        self._live = live
        self._send = send
        self._make_reader = make_reader
        self._wanted = Wanted()
        self._check_run = check_run
        self._shown: _OpenRecording | None = None
        self._check: RunCheck | None = None
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
        return state if check is None else replace(state, run=check.verdict)

    @property
    def problem(self) -> str:
        """Why the recording cannot be read any further; empty if it can."""
        shown = self._shown
        return "" if shown is None else shown.problem

    def open(self, path: Path) -> None:
        """Show a recording from its beginning; a run is verified first, and then shown.

        Raises:
            PageRecordingError: it cannot be read.
        """
        if is_run(path):
            self.close()
            with self._change:
                self._check = self._check_run(path, lambda *found: self._show_run(path, *found))
            return
        opened = _OpenRecording(path, self._make_reader, self._wanted)
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
        if check is not None:
            check.close()

    def _show_run(self, path: Path, check: RunCheck, bag: Path | None) -> None:
        """Show what a run did, unless something else is shown by now."""
        with self._change:
            if bag is None or self._check is not check:
                return
            try:
                self._shown = _OpenRecording(bag, self._make_reader, self._wanted, path)
            except PageRecordingError as error:
                check.fail(str(error))
            else:
                self._shown.start()

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

    def _opened(self) -> "_OpenRecording":
        shown = self._shown
        if shown is None:
            raise PageRecordingError("no recording is open")
        return shown


@dataclass(slots=True)
class _Wish:
    """What the thread of a recording has to show next."""

    playback: Playback
    wanted: Wanted
    has_jumped: bool = True
    marks: tuple[Mark, ...] = ()
    curve: ShownCurve | None = None
    numbers: Mapping[tuple[str, str], NumberPlace] = field(
        default_factory=lambda: MappingProxyType({})
    )


class _OpenRecording:
    """An open recording with its two threads: one makes snapshots, one reads curves.

    Each has the file open for itself, and closes it at its end.
    """

    def __init__(
        self,
        path: Path,
        make_reader: Callable[[RecordedBag], StateReader],
        wanted: Wanted,
        original: Path | None = None,
    ) -> None:
        # Marks stand beside the file that the user knows.
        self._path = original or path
        self._make_reader = make_reader
        recording = RecordedBag(path)
        self._start_ns = recording.start_ns
        self._length_s = 1e-9 * (recording.end_ns - self._start_ns)
        self._wish = _Wish(Playback(self._length_s), wanted)
        self._lock = threading.Lock()
        self._changed = threading.Event()
        self._curve_wanted = threading.Event()
        self._ended = False
        self._now_s = time.monotonic()
        self.snapshot: Snapshot | None = None
        self.problem = ""
        try:
            self._wish.marks = read_marks(self._path)
        except PageRecordingError as error:
            self.problem = str(error)
        self._threads = [
            threading.Thread(target=self._guarded, args=(run, opened), name="replay", daemon=True)
            for run, opened in ((self._play, recording), (self._read_curves, RecordedBag(path)))
        ]

    @property
    def state(self) -> PlayerState:
        with self._lock:
            wish, playback = self._wish, self._wish.playback
            return PlayerState(
                name=self._path.name,
                began_ns=self._start_ns,
                length_s=self._length_s,
                time_s=playback.time_s,
                is_playing=playback.is_playing,
                speed=playback.speed,
                marks=wish.marks,
                numbers=tuple(wish.numbers),
                curve=wish.curve,
            )

    def start(self) -> None:
        for thread in self._threads:
            thread.start()

    def end(self) -> None:
        self._ended = True
        self._changed.set()
        self._curve_wanted.set()

    def act(self, change: Callable[[Playback], None]) -> None:
        with self._lock:
            before_s = self._wish.playback.time_s
            change(self._wish.playback)
            if self._wish.playback.time_s != before_s:
                self._wish.has_jumped = True
        self._changed.set()

    def show(self, wanted: Wanted) -> None:
        with self._lock:
            self._wish.wanted = wanted
        self._changed.set()

    def show_curve(self, topic: str, number: str) -> None:
        with self._lock:
            if (topic, number) not in self._wish.numbers:
                raise PageRecordingError(f"{topic} of the recording has no number '{number}'")
            self._wish.curve = ShownCurve(topic, number)
        self._curve_wanted.set()

    def set_marks(self, change: Callable[[tuple[Mark, ...]], tuple[Mark, ...]]) -> None:
        with self._lock:
            marks = tuple(sorted(change(self._wish.marks)))
            write_marks(self._path, marks)
            self._wish.marks = marks

    def _guarded(self, run: Callable[[RecordedBag], None], recording: RecordedBag) -> None:
        try:
            with closing(recording):
                run(recording)
        except PageRecordingError as error:
            self.problem = str(error)
        except Exception:
            # The thread's top-level handler: the page goes on without this recording.
            logging.getLogger(__name__).exception("a recording cannot be shown")
            self.problem = f"{self._path.name} cannot be shown; the page's log says why"

    def _play(self, recording: RecordedBag) -> None:
        reader = self._make_reader(recording)
        passed_from_s = time.monotonic()
        is_new = True
        while not self._ended:
            with self._lock:
                now_s = time.monotonic()
                playback, before_s = self._wish.playback, self._wish.playback.time_s
                playback.advance(now_s - passed_from_s)
                passed_from_s = now_s
                # The first snapshot after a jump stands for itself; the next ones go on from it.
                jumped, self._wish.has_jumped = self._wish.has_jumped, False
                self._now_s += JUMP_S if jumped else playback.time_s - before_s
                moment_s, wanted = playback.time_s, self._wish.wanted
                speed = playback.speed if playback.is_playing else 0.0
            time_ns = self._start_ns + round(moment_s * 1e9)
            self.snapshot = reader.at(time_ns, self._now_s, speed, wanted)
            if is_new:
                # What waits for a robot's joints to arrive has waited long enough.
                self._now_s += JUMP_S
                is_new = False
                continue
            if speed:
                self._changed.wait(TICK_S)
            else:
                while not self._changed.wait(IDLE_S) and not self._ended:
                    pass
                passed_from_s = time.monotonic()
            self._changed.clear()

    def _read_curves(self, recording: RecordedBag) -> None:
        """Read the curves that are wanted."""
        numbers = self._make_reader(recording).numbers()
        with self._lock:
            self._wish.numbers = numbers
            first = next(iter(numbers), None)
            if first is not None:
                self._wish.curve = ShownCurve(*first)
                self._curve_wanted.set()
        while not self._ended:
            self._curve_wanted.wait()
            self._curve_wanted.clear()
            self._read_curve(recording, numbers)

    def _read_curve(
        self, recording: RecordedBag, numbers: Mapping[tuple[str, str], NumberPlace]
    ) -> None:
        with self._lock:
            shown = self._wish.curve
        if shown is None or shown.curve is not None:
            return
        place = numbers[shown.topic, shown.number]
        curve = read_curve(
            recording, shown.topic, place, lambda: not self._ended and self._wish.curve is shown
        )
        with self._lock:
            if self._wish.curve is shown:
                self._wish.curve = replace(shown, curve=curve)
