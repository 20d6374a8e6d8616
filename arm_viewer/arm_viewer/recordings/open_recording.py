"""A recording that is open: its position, what is shown there, its marks and its curve."""

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
from arm_viewer.recordings.run_check import EqualPart, RunVerdict
from arm_viewer.snapshot import Snapshot

TICK_S = 1.0 / 30.0
IDLE_S = 0.2
JUMP_S = 20.0
"""Shown time between two moments that do not follow each other: longer than charts reach back."""


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

    def reread(self) -> None:
        """Take notice that the recording has got longer."""
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
        open_s: up to where it can be shown; a run, as far as it has been verified.
        time_s: the moment that is shown, from its beginning.
        is_playing: whether it plays.
        speed: recorded seconds a second.
        marks: its marks, in order.
        numbers: the numbers that have a curve, by topic.
        curve: the number whose curve is shown.
        run: what is known about the run that it is, or that is being verified while the page is
            live; None for a bag.
        stopped: what a verification that was stopped has not compared; empty if none was.
    """

    name: str = ""
    began_ns: int = 0
    length_s: float = 0.0
    open_s: float = 0.0
    time_s: float = 0.0
    is_playing: bool = False
    speed: float = 1.0
    marks: tuple[Mark, ...] = ()
    numbers: tuple[tuple[str, str], ...] = ()
    curve: ShownCurve | None = None
    run: RunVerdict | None = None
    stopped: str = ""


@dataclass(slots=True)
class _Wish:
    """What the threads of a recording have to show next."""

    playback: Playback
    wanted: Wanted
    part: EqualPart
    has_jumped: bool = True
    marks: tuple[Mark, ...] = ()
    curve: ShownCurve | None = None
    numbers: Mapping[tuple[str, str], NumberPlace] = field(
        default_factory=lambda: MappingProxyType({})
    )


class OpenRecording:
    """An open recording with its two threads: one makes snapshots, one reads curves.

    Each has the files open for itself, and closes them at its end. Any thread may call the methods.

    Attributes:
        snapshot: what it shows; None until it is read.
        problem: why it cannot be read any further; empty if it can.
    """

    def __init__(
        self,
        path: Path,
        make_reader: Callable[[RecordedBag], StateReader],
        wanted: Wanted,
        part: EqualPart | None = None,
        length_s: float = 0.0,
    ) -> None:
        """Open it.

        Args:
            path: the recording that its user knows; its marks stand beside it.
            make_reader: returns what reads its messages.
            wanted: what of it is shown.
            part: for a run, as much of it as can be shown now.
            length_s: for a run, its whole length.

        Raises:
            PageRecordingError: it cannot be read.
        """
        self._path = path
        self._make_reader = make_reader
        part = part or EqualPart(grows=False)
        recording = RecordedBag(path, part.files)
        self._start_ns = recording.start_ns
        if not part.files:
            length_s = 1e-9 * (recording.end_ns - self._start_ns)
            part = replace(part, until_s=length_s)
        playback = Playback(length_s, open_s=part.until_s, grows=part.grows)
        self._wish = _Wish(playback, wanted, part)
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
            for run, opened in (
                (self._play, recording),
                (self._read_curves, RecordedBag(path, part.files)),
            )
        ]

    @property
    def state(self) -> PlayerState:
        """What it shows, but for what is known about a run."""
        with self._lock:
            wish, playback = self._wish, self._wish.playback
            return PlayerState(
                name=self._path.name,
                began_ns=self._start_ns,
                length_s=playback.length_s,
                open_s=playback.end_s,
                time_s=playback.time_s,
                is_playing=playback.is_playing,
                speed=playback.speed,
                marks=wish.marks,
                numbers=tuple(wish.numbers),
                curve=wish.curve,
            )

    def start(self) -> None:
        """Start the threads."""
        for thread in self._threads:
            thread.start()

    def end(self) -> None:
        """Let the threads end."""
        self._ended = True
        self._changed.set()
        self._curve_wanted.set()

    def extend(self, part: EqualPart) -> None:
        """Show more of a run."""
        with self._lock:
            self._wish.part = part
            playback = self._wish.playback
            playback.open_s, playback.grows = part.until_s, part.grows
        self._changed.set()
        self._curve_wanted.set()

    def act(self, change: Callable[[Playback], None]) -> None:
        """Change the position or the speed."""
        with self._lock:
            before_s = self._wish.playback.time_s
            change(self._wish.playback)
            if self._wish.playback.time_s != before_s:
                self._wish.has_jumped = True
        self._changed.set()

    def show(self, wanted: Wanted) -> None:
        """Show other pictures and curves."""
        with self._lock:
            self._wish.wanted = wanted
        self._changed.set()

    def show_curve(self, topic: str, number: str) -> None:
        """Read the curve of a number; raises PageRecordingError if there is no such number."""
        with self._lock:
            if (topic, number) not in self._wish.numbers:
                raise PageRecordingError(f"{topic} of the recording has no number '{number}'")
            self._wish.curve = ShownCurve(topic, number)
        self._curve_wanted.set()

    def set_marks(self, change: Callable[[tuple[Mark, ...]], tuple[Mark, ...]]) -> None:
        """Change the marks and write them; raises PageRecordingError if they cannot be written."""
        with self._lock:
            marks = tuple(sorted(change(self._wish.marks)))
            write_marks(self._path, marks)
            self._wish.marks = marks

    def _guarded(self, run: Callable[[RecordedBag], None], recording: RecordedBag) -> None:
        try:
            with closing(recording):
                run(recording)
        except PageRecordingError as error:
            # A run that is left takes its files with it.
            if not self._ended:
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
                files = self._wish.part.files
            if recording.extend(files):
                reader.reread()
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
        """Read the curves that are wanted, anew when the recording has got longer."""
        is_longer = True
        while not self._ended:
            if is_longer:
                numbers = self._make_reader(recording).numbers()
                with self._lock:
                    self._wish.numbers = numbers
                    first = next(iter(numbers), None)
                    if self._wish.curve is None and first is not None:
                        self._wish.curve = ShownCurve(*first)
            self._read_curve(recording, is_longer)
            self._curve_wanted.wait()
            self._curve_wanted.clear()
            is_longer = recording.extend(self._wish.part.files)

    def _read_curve(self, recording: RecordedBag, is_longer: bool) -> None:
        with self._lock:
            shown, length_s = self._wish.curve, self._wish.playback.length_s
        if shown is None or (shown.curve is not None and not is_longer):
            return
        place = self._wish.numbers.get((shown.topic, shown.number))
        if place is None:
            return
        curve = read_curve(
            recording,
            shown.topic,
            place,
            lambda: not self._ended and self._wish.curve is shown,
            length_s,
        )
        with self._lock:
            if self._wish.curve is shown:
                self._wish.curve = replace(shown, curve=curve)
