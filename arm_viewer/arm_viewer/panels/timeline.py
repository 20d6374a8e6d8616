"""The recordings: their list, the recorder, and the timeline at the bottom of the page.

All of it is part of the served page (`front/timeline.*`). This panel sends it what to show and
serves its buttons.
"""

import math
import time
from dataclasses import asdict
from typing import Any

from viser import GuiApi

from arm_viewer.channel import Browser, Channel, Message
from arm_viewer.errors import BrowserMessageError, PageRecordingError
from arm_viewer.recordings.curve import WholeCurve
from arm_viewer.recordings.folder import find_recording, listed_recordings
from arm_viewer.recordings.marks import MAX_TEXT, Mark
from arm_viewer.recordings.open_recording import PlayerState, ShownCurve
from arm_viewer.recordings.playback import MAX_SPEED, MIN_SPEED, Playback
from arm_viewer.recordings.player import REFUSED, Player
from arm_viewer.recordings.recorder import Recorder, RecorderState
from arm_viewer.snapshot import Snapshot

TIMELINE, MOMENT, CURVE, RECORDINGS, RECORD = (
    "timeline",
    "timeline_moment",
    "timeline_curve",
    "recordings",
    "record",
)
"""Kinds of messages: the open recording, its moment, its curve; the list; the recorder."""
RECORDER_PERIOD_S = 0.5
SAME_MARK_S = 0.001


def timeline_fields(state: PlayerState, problem: str, refusals: int) -> dict[str, Any]:
    """Return what the timeline shows, but for the moment and the curve."""
    return {
        "name": state.name,
        "began_s": 1e-9 * state.began_ns,
        "length_s": state.length_s,
        "open_s": state.open_s,
        "playing": state.is_playing,
        "speed": state.speed,
        "marks": [[mark.time_s, mark.text] for mark in state.marks],
        "numbers": [list(number) for number in state.numbers],
        "problem": problem,
        "refusals": refusals,
        "refused": REFUSED,
        "run": None if state.run is None else asdict(state.run),
        "stopped": state.stopped,
    }


def curve_fields(shown: ShownCurve | None) -> dict[str, Any]:
    """Return the curve as lists of numbers; None where there is none."""
    if shown is None:
        return {"topic": "", "number": "", "low": [], "high": [], "read": True, "skipped": 0}
    curve = shown.curve
    return {
        "topic": shown.topic,
        "number": shown.number,
        "low": [] if curve is None else _plain(curve, "low"),
        "high": [] if curve is None else _plain(curve, "high"),
        "read": curve is not None,
        "skipped": 0 if curve is None else curve.skipped,
    }


def recorder_fields(state: RecorderState) -> dict[str, Any]:
    """Return what the recorder does."""
    return {
        "path": "" if state.path is None else str(state.path),
        "recording": state.is_recording,
        "starting": state.is_starting,
        "seconds": round(state.seconds),
        "bytes": state.size_bytes,
        "dropped": state.dropped,
        "said": state.said,
    }


def _plain(curve: WholeCurve, name: str) -> list[float | None]:
    values = getattr(curve, name).tolist()
    return [None if math.isnan(value) else float(f"{value:.6g}") for value in values]


class TimelinePanel:
    """Keeps the timeline of every browser up to date, and serves its buttons."""

    def __init__(self, channel: Channel, player: Player, recorder: Recorder) -> None:
        """Show this player and this recorder over the page's channel."""
        self._channel = channel
        self._player = player
        self._recorder = recorder
        self._shown: dict[str, dict[str, Any]] = {}
        self._curve: ShownCurve | None = None
        self._looked_s = -math.inf
        self._was_recording = False

    def build(self, gui: GuiApi) -> None:
        """Serve the buttons."""
        self._channel.on(TIMELINE, self._take_timeline)
        self._channel.on(RECORD, self._take_record)
        self._channel.on(RECORDINGS, self._take_list, changes=False)

    def update(self, snapshot: Snapshot) -> None:
        """Send what has changed to the browsers."""
        state = self._player.state
        self._show(MOMENT, {"time_s": round(state.time_s, 3)})
        self._show(TIMELINE, timeline_fields(state, self._player.problem, self._player.refusals))
        if CURVE not in self._shown or state.curve is not self._curve:
            self._curve = state.curve
            self._show(CURVE, curve_fields(state.curve))
        now_s = time.monotonic()
        if now_s - self._looked_s >= RECORDER_PERIOD_S:
            self._looked_s = now_s
            doing = self._recorder.state
            if doing.is_recording != self._was_recording or RECORDINGS not in self._shown:
                self._was_recording = doing.is_recording
                self._list()
            self._show(RECORD, recorder_fields(doing))

    def _show(self, kind: str, fields: dict[str, Any]) -> None:
        if fields != self._shown.get(kind):
            self._shown[kind] = fields
            self._channel.send(kind, fields, keep=True)

    def _list(self) -> None:
        found = listed_recordings(self._recorder.folder)
        rows = [[one.name, one.size_bytes, one.changed_s, one.is_run] for one in found]
        folder = str(self._recorder.folder.absolute())
        self._show(RECORDINGS, {"folder": folder, "found": rows})

    def _take_list(self, message: Message, browser: Browser) -> None:
        self._list()

    def _take_record(self, message: Message, browser: Browser) -> None:
        try:
            match message.text("do"):
                case "start":
                    self._recorder.start(message.texts("topics"))
                case "start_run":
                    self._recorder.start_run()
                case "stop":
                    self._recorder.stop()
                case other:
                    raise BrowserMessageError(f"the recorder does not have '{other}'")
        except PageRecordingError as error:
            raise BrowserMessageError(str(error)) from error
        self._looked_s = -math.inf

    def _take_timeline(self, message: Message, browser: Browser) -> None:
        try:
            self._serve(message)
        except PageRecordingError as error:
            raise BrowserMessageError(str(error)) from error

    def _serve(self, message: Message) -> None:
        player = self._player
        match message.text("do"):
            case "open":
                player.open(find_recording(self._recorder.folder, message.text("name")))
            case "live":
                player.close()
            case "play":
                player.act(Playback.play)
            case "pause":
                player.act(Playback.pause)
            case "seek":
                time_s = message.number("time_s")
                player.act(lambda playback: playback.seek(time_s))
            case "speed":
                factor = message.number("factor")
                if not MIN_SPEED <= factor <= MAX_SPEED:
                    raise BrowserMessageError(
                        f"'factor' goes from {MIN_SPEED:g} to {MAX_SPEED:g}, not {factor:g}"
                    )
                player.act(lambda playback: playback.set_speed(factor))
            case "curve":
                player.show_curve(message.text("topic"), message.text("number"))
            case "mark":
                mark = Mark(message.number("time_s"), message.text("text").strip()[:MAX_TEXT])
                player.set_marks(lambda marks: (*_without(marks, mark.time_s), mark))
            case "unmark":
                time_s = message.number("time_s")
                player.set_marks(lambda marks: _without(marks, time_s))
            case other:
                raise BrowserMessageError(f"the timeline does not have '{other}'")


def _without(marks: tuple[Mark, ...], time_s: float) -> tuple[Mark, ...]:
    return tuple(mark for mark in marks if abs(mark.time_s - time_s) > SAME_MARK_S)
