"""The bar at the top of the page: the simulation's time, its snapshots, and the emergency stop.

The bar itself is part of the served page (`front/time_bar.*`). This panel sends it what to show,
serves its buttons, and puts the same deeds into viser's command palette.
"""

import math
import re
import time
from collections.abc import Callable, Mapping
from typing import Any

from viser import CommandHandle, GuiApi

from arm_viewer.channel import Browser, Channel, Message
from arm_viewer.errors import BrowserMessageError
from arm_viewer.panels.panel import in_order
from arm_viewer.requests import (
    Request,
    ResetRun,
    Send,
    SetEmergencyStop,
    SetPlaying,
    SetSpeed,
    SnapshotDeed,
    StepRun,
    UseSnapshot,
)
from arm_viewer.snapshot import Snapshot

BAR, CLOCK, RUN, STOP = "time_bar", "clock", "run", "emergency_stop"
"""Kinds of messages: what the bar shows, the time alone, and the user's wishes."""
CLOCK_PERIOD_S = 0.1
REPEAT_S = 0.8
"""The bar is sent at least this often; a browser without news greys it after two seconds."""
STALE_S = 2.0
MIN_LAG_S = 0.05
MAX_STEPS = 10_000
MAX_SPEED = 1000.0

RECORDING = "recording"
"""The state that the bar shows for a moment of a recording."""
REPLAYED = "This is a recording: go back to live first"
NO_SIMULATION = "No simulation: {what}"
PLAYING = "Pause first: only a paused simulation takes steps"
NO_WORLD = "No world is loaded"
NO_STOP = "No robot here offers an emergency stop"
RELEASED = "The emergency stop is not engaged"
NONE_SAVED = "There is no snapshot yet"
_NAME = re.compile(r"[A-Za-z0-9_.\-]{1,100}", re.ASCII)
_FILE_SUFFIX = ".snapshot"


def bar_fields(snapshot: Snapshot, now_s: float) -> dict[str, Any]:
    """Return what the bar shows, but for the running time; times are on the clock of `made_s`."""
    run, answer = snapshot.run, snapshot.control_answer
    return {
        "state": RECORDING if snapshot.replay else "" if run is None else run.state,
        "speed": None if run is None or math.isnan(run.speed) else run.speed,
        "snapshots": [] if run is None else [[s.name, s.description] for s in run.snapshots],
        "stopped": [name or "/" for name, active in sorted(snapshot.stops.items()) if active],
        "reasons": reasons(snapshot),
        "answer": {"number": answer.number, "text": answer.text, "done": answer.is_done},
        "stale": not snapshot.replay and now_s - snapshot.made_s > STALE_S,
    }


def reasons(snapshot: Snapshot) -> dict[str, str]:
    """Return why each deed is impossible now; "" where it is possible."""
    run = snapshot.run
    found = {"stop": "" if snapshot.stops else NO_STOP}
    found["release"] = "" if any(snapshot.stops.values()) else RELEASED
    if snapshot.replay:
        return found | dict.fromkeys(
            ("play", "step", "speed", "reset", "save", "restore"), REPLAYED
        )
    if run is None:
        missing = {
            "play": "time cannot be paused",
            "step": "time cannot be stepped",
            "speed": "time has no other speed",
            "reset": "nothing can be reset",
            "save": "nothing can be saved",
            "restore": "nothing can be restored",
        }
        return found | {name: NO_SIMULATION.format(what=what) for name, what in missing.items()}
    no_world = NO_WORLD if run.state in ("no world", "loading a world") else ""
    return found | {
        "play": no_world,
        "step": PLAYING if run.is_playing else no_world,
        "speed": "The simulation has not told its speed yet" if math.isnan(run.speed) else "",
        "reset": no_world,
        "save": no_world,
        "restore": no_world or ("" if run.snapshots else NONE_SAVED),
    }


def clock_fields(snapshot: Snapshot, now_s: float) -> dict[str, Any]:
    """Return simulation time and pace, rounded to what is shown; see `bar_fields`."""
    clock, run = snapshot.time, snapshot.run
    if clock is None:
        return {"time_s": None, "factor": None, "lag_s": None, "silent_s": None}
    silent_s = 0.0 if snapshot.replay else now_s - clock.received_s
    waits = snapshot.replay != "" or (run is not None and not run.is_playing)
    # At another speed than real time, the distance from wall time is no lag.
    lags = run is not None and run.is_playing and run.speed == 1.0 and clock.lag_s >= MIN_LAG_S
    return {
        "time_s": round(clock.time_s, 2),
        "factor": None if waits else round(clock.factor, 2),
        "lag_s": round(clock.lag_s, 2) if lags else None,
        "silent_s": round(silent_s) if silent_s > STALE_S and not waits else None,
    }


def free_name(taken: Mapping[str, object]) -> str:
    """Return the first of "snapshot-1", "snapshot-2"... that is not taken."""
    number = 1
    while f"snapshot-{number}" in taken:
        number += 1
    return f"snapshot-{number}"


def run_request(message: Message, snapshot: Snapshot) -> Request:
    """Return the request that a browser's message stands for.

    Raises:
        BrowserMessageError: it stands for none.
    """
    match message.text("do"):
        case "play":
            return SetPlaying(True)
        case "pause":
            return SetPlaying(False)
        case "step":
            return StepRun(int(_between(message, "count", 1, MAX_STEPS)))
        case "speed":
            return SetSpeed(_between(message, "factor", 0.0, MAX_SPEED))
        case "reset":
            return ResetRun(message.flag("keeps_clock"))
        case "save":
            return UseSnapshot(SnapshotDeed.SAVE, _name(message, snapshot))
        case ("restore" | "remove") as deed:
            return UseSnapshot(SnapshotDeed(deed), _name(message, snapshot))
        case other:
            raise BrowserMessageError(f"the time bar does not have '{other}'")


def _between(message: Message, name: str, lower: float, upper: float) -> float:
    number = message.number(name)
    if not lower <= number <= upper:
        raise BrowserMessageError(f"'{name}' goes from {lower:g} to {upper:g}, not {number:g}")
    return number


def _name(message: Message, snapshot: Snapshot) -> str:
    """Return the name of a snapshot; anything else would be a file of the simulation."""
    name = message.text("name").strip()
    if not name and message.text("do") == "save":
        return _next_name(snapshot)
    if not _NAME.fullmatch(name) or name.endswith(_FILE_SUFFIX):
        raise BrowserMessageError(
            f"'{name}' is not a name of a snapshot; it takes 1 to 100 letters, digits and _ . -, "
            f"and does not end with {_FILE_SUFFIX}"
        )
    return name


def _next_name(snapshot: Snapshot) -> str:
    saved = () if snapshot.run is None else snapshot.run.snapshots
    return free_name({found.name: None for found in saved})


class TimeBar:
    """Keeps the bar of every browser up to date, and passes on what its buttons want."""

    def __init__(self, channel: Channel, send: Send) -> None:
        """Use the page's channel; send requests with `send`."""
        self._channel = channel
        self._send = send
        self._snapshot = Snapshot()
        self._shown: dict[str, dict[str, Any]] = {}
        self._shown_s: dict[str, float] = {}
        self._commands: list[_PaletteCommand] = []

    def build(self, gui: GuiApi) -> None:
        """Serve the bar's buttons, and create the commands."""
        self._channel.on(RUN, self._take_run)
        self._channel.on(STOP, self._take_stop)
        self._commands = [
            _PaletteCommand(gui, label, key, needs, self._sender(make))
            for label, key, needs, make in (
                ("Pause or play", "Space", "play", self._toggle),
                ("Step once", "→ or .", "step", lambda: StepRun(1)),
                ("Step 10 times", "Shift →", "step", lambda: StepRun(10)),
                ("Step 100 times", "Ctrl →", "step", lambda: StepRun(100)),
                ("Speed: real time", "", "speed", lambda: SetSpeed(1.0)),
                ("Speed: half", "", "speed", lambda: SetSpeed(0.5)),
                ("Speed: a tenth", "", "speed", lambda: SetSpeed(0.1)),
                ("Speed: as fast as possible", "", "speed", lambda: SetSpeed(0.0)),
                ("Reset everything and the clock", "R", "reset", lambda: ResetRun(False)),
                ("Reset, and keep the clock", "Shift R", "reset", lambda: ResetRun(True)),
                ("Save a snapshot", "Ctrl S", "save", self._save),
                ("Restore the newest snapshot", "L", "restore", self._restore),
                ("Emergency stop", "Esc", "stop", lambda: SetEmergencyStop(True)),
                ("Release the emergency stop", "", "release", lambda: SetEmergencyStop(False)),
            )
        ]

    def update(self, snapshot: Snapshot) -> None:
        """Send what has changed to the browsers."""
        self._snapshot = snapshot
        now_s = time.monotonic()
        impossible = reasons(snapshot)
        for command in self._commands:
            command.update(impossible)
        if not self._channel.is_used:
            # The next browser gets everything at once.
            self._shown.clear()
            return
        has_changed = self._show(BAR, bar_fields(snapshot, now_s), now_s, 0.0)
        # So that a pause shows the time at which it began.
        period_s = 0.0 if has_changed else CLOCK_PERIOD_S
        self._show(CLOCK, clock_fields(snapshot, now_s), now_s, period_s)

    def _show(self, kind: str, fields: dict[str, Any], now_s: float, period_s: float) -> bool:
        """Send what a message of this kind shows if it is due; return whether it was."""
        passed_s = now_s - self._shown_s.get(kind, -math.inf)
        is_new = fields != self._shown.get(kind)
        is_due = (is_new and passed_s >= period_s) or passed_s >= REPEAT_S
        if is_due or kind not in self._shown:
            self._shown[kind] = fields
            self._shown_s[kind] = now_s
            self._channel.send(kind, fields, keep=True)
            return True
        return False

    def _take_run(self, message: Message, browser: Browser) -> None:
        self._send(run_request(message, self._snapshot))

    def _take_stop(self, message: Message, browser: Browser) -> None:
        self._send(SetEmergencyStop(message.flag("engaged")))

    def _sender(self, make: Callable[[], Request]) -> Callable[[Any], None]:
        return lambda _: self._send(make())

    def _toggle(self) -> Request:
        run = self._snapshot.run
        return SetPlaying(run is None or not run.is_playing)

    def _save(self) -> Request:
        return UseSnapshot(SnapshotDeed.SAVE, _next_name(self._snapshot))

    def _restore(self) -> Request:
        run = self._snapshot.run
        newest = run.snapshots[-1].name if run is not None and run.snapshots else ""
        return UseSnapshot(SnapshotDeed.RESTORE, newest)


class _PaletteCommand:
    """An entry of viser's command palette; it says why it is disabled."""

    def __init__(
        self, gui: GuiApi, label: str, key: str, needs: str, serve: Callable[[Any], None]
    ) -> None:
        self._key = key
        self._needs = needs
        self._reason = ""
        # viser would fire a hotkey of its own on a focused button; the bar's script has the keys.
        self._handle: CommandHandle = gui.add_command(label, description=key or None)
        self._handle.on_trigger(in_order(serve))

    def update(self, impossible: Mapping[str, str]) -> None:
        reason = impossible[self._needs]
        if reason != self._reason:
            self._reason = reason
            self._handle.disabled = bool(reason)
            self._handle.description = reason or self._key or None
