"""The plots of the page: sends each browser the curves that it draws.

The plots themselves are a part of the served page (`front/plots.*`). A browser names the curves
that it draws, each with a number of its own, and gets their samples in binary frames: those that
there are at once, and then what is new.
"""

import math
import struct
import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from viser import GuiApi

from arm_viewer.channel import Browser, Channel, Message
from arm_viewer.errors import BrowserMessageError
from arm_viewer.plots.field_paths import parse_curve, unit_of
from arm_viewer.plots.history import Curves, CurveSamples, thinned
from arm_viewer.requests import ListNumbers, PlotCurves, Send
from arm_viewer.snapshot import Description, JointReading, ListedController, Snapshot

ADD, REMOVE, NUMBERS, JOINTS, RESTART = (
    *("plot_add", "plot_remove", "plot_numbers", "plot_joints", "plot_restart"),
)
"""Kinds of messages: a curve to draw, or no more; the numbers that there are; the robots' joints;
and that all samples so far are of another run."""
FRAME = 2
"""The kind of the binary frames.

They begin with the time in s (float64). Blocks of curves with the same times follow: how many
times and how many curves (uint32), the curves' numbers (uint32), the times relative to that of the
frame, and the values, curve by curve (float32)."""
PERIOD_S = 1.0 / 15.0
JOINTS_PERIOD_S = 0.5
MAX_SAMPLES = 8192
"""More samples of a curve are thinned before they are sent; so much fills any screen."""
MAX_CURVES = 200
KEEP_S = 30.0
"""A curve that nobody draws any more is collected this long, for a page that is loaded again."""
QUANTITIES = ("position", "velocity", "effort")


@dataclass(slots=True)
class _Drawing:
    """What a browser draws: the names and how far they are sent, by the browser's number."""

    names: dict[int, str] = field(default_factory=dict)
    sent_s: dict[int, float] = field(default_factory=dict)


class PlotFeed:
    """Serves the plots of all browsers."""

    def __init__(self, channel: Channel, send: Send) -> None:
        """Use the page's channel; send requests with `send`."""
        self._channel = channel
        self._send = send
        self._drawings: dict[Browser, _Drawing] = {}
        self._askers: dict[Browser, Any] = {}
        self._wanted: frozenset[str] = frozenset()
        self._drawn_s: dict[str, float] = {}
        self._curves: Curves | None = None
        self._joints: dict[str, Any] = {}
        self._slides: dict[str, bool] = {}
        self._sent_s = self._joints_s = -math.inf

    def build(self, gui: GuiApi) -> None:
        """Serve the browsers' messages."""
        self._channel.on(ADD, self._take_curve, changes=False)
        self._channel.on(REMOVE, self._take_removal, changes=False)
        self._channel.on(NUMBERS, self._take_question, changes=False)

    def update(self, snapshot: Snapshot) -> None:
        """Send what is new and due."""
        for browser in [b for b in self._drawings if not b.is_connected]:
            del self._drawings[browser]
        now_s = time.monotonic()
        self._want(now_s)
        if snapshot.curves is not self._curves:
            self._restart(snapshot.curves)
        if now_s - self._joints_s >= JOINTS_PERIOD_S:
            self._joints_s = now_s
            self._offer_joints(snapshot)
        self._answer(snapshot)
        if now_s - self._sent_s >= PERIOD_S:
            self._sent_s = now_s
            for browser, drawing in self._drawings.items():
                self._feed(browser, drawing, snapshot)

    def _want(self, now_s: float) -> None:
        """Have the curves collected that somebody draws, or drew until a short time ago."""
        for drawing in self._drawings.values():
            self._drawn_s.update(dict.fromkeys(drawing.names.values(), now_s))
        wanted = frozenset(n for n, drawn_s in self._drawn_s.items() if now_s - drawn_s < KEEP_S)
        if wanted != self._wanted:
            self._wanted = wanted
            self._drawn_s = {name: self._drawn_s[name] for name in wanted}
            self._send(PlotCurves(wanted))

    def _restart(self, curves: Curves) -> None:
        if self._curves is not None:
            self._channel.send(RESTART, {})
        self._curves = curves
        for drawing in self._drawings.values():
            drawing.sent_s.clear()

    def _feed(self, browser: Browser, drawing: _Drawing, snapshot: Snapshot) -> None:
        curves = snapshot.curves
        now_s = time.time() if math.isnan(snapshot.curves_s) else snapshot.curves_s
        blocks: dict[bytes, list[tuple[int, CurveSamples]]] = {}
        for number, name in drawing.names.items():
            new = curves.since(name, drawing.sent_s.get(number, -math.inf))
            if len(new.times):
                shown = thinned(new, MAX_SAMPLES // 2) if len(new.times) > MAX_SAMPLES else new
                blocks.setdefault(shown.times.tobytes(), []).append((number, shown))
        # A browser that lags behind gets the rest later.
        if browser.send_bytes(FRAME, frame(now_s, list(blocks.values()))):
            for block in blocks.values():
                for number, samples in block:
                    drawing.sent_s[number] = float(samples.times[-1])

    def _answer(self, snapshot: Snapshot) -> None:
        """Tell those who asked which numbers there are, as long as more are found."""
        for browser, told in tuple(self._askers.items()):
            if not browser.is_connected:
                del self._askers[browser]
            elif told is not snapshot.numbers:
                self._askers[browser] = snapshot.numbers
                found = {
                    topic: [[path, unit_of(path, self._slides)] for path in paths]
                    for topic, paths in sorted(snapshot.numbers.items())
                    if paths
                }
                browser.send(NUMBERS, {"topics": found})

    def _offer_joints(self, snapshot: Snapshot) -> None:
        offered = joint_curves(snapshot)
        if offered != self._joints:
            self._joints = offered
            self._slides = {
                joint["name"]: joint["slides"]
                for robot in offered["robots"]
                for joint in robot["joints"]
            }
            self._channel.send(JOINTS, offered, keep=True)

    def _take_curve(self, message: Message, browser: Browser) -> None:
        name, number = message.text("name"), int(message.number("number"))
        parse_curve(name)
        drawing = self._drawings.setdefault(browser, _Drawing())
        if len(drawing.names) >= MAX_CURVES:
            raise BrowserMessageError(f"a browser draws at most {MAX_CURVES} curves")
        if not 0 <= number < 2**32:
            raise BrowserMessageError(f"a curve's number goes from 0 to 4294967295, not {number}")
        drawing.names[number] = name
        drawing.sent_s.pop(number, None)

    def _take_removal(self, message: Message, browser: Browser) -> None:
        drawing, number = self._drawings.get(browser, _Drawing()), int(message.number("number"))
        drawing.names.pop(number, None)
        drawing.sent_s.pop(number, None)

    def _take_question(self, message: Message, browser: Browser) -> None:
        self._askers[browser] = None
        self._send(ListNumbers())


def frame(now_s: float, blocks: list[list[tuple[int, CurveSamples]]]) -> bytes:
    """Return the payload of a FRAME at a time since the epoch, with blocks of numbered curves.

    The curves of a block have the same times.
    """
    parts = [struct.pack("<d", now_s)]
    for block in blocks:
        times = block[0][1].times
        numbers = [number for number, _ in block]
        parts.append(np.array([len(times), len(block), *numbers], "<u4").tobytes())
        parts.append((times - now_s).astype("<f4").tobytes())
        parts += [samples.values.astype("<f4").tobytes() for _, samples in block]
    return b"".join(parts)


def joint_curves(snapshot: Snapshot) -> dict[str, Any]:
    """Return the robots, their joints, and the curves of the states and commands of each.

    Joints that follow others are left out: their curves say nothing new.
    """
    robots: list[dict[str, Any]] = []
    for topic, states in sorted(snapshot.joint_states.items()):
        namespace = topic.rpartition("/")[0]
        described = snapshot.descriptions.get(f"{namespace}/robot_description")
        commands = _commands(snapshot, namespace)
        slides, followers = _kinds(described)
        joints = [
            {
                "name": name,
                "slides": slides.get(name, False),
                "curves": {
                    quantity: [
                        f"{topic}.{quantity}[{name}]",
                        *commands.get(f"{name}/{quantity}", (None, False)),
                        unit_of(f"{quantity}[{name}]", slides),
                    ]
                    for quantity in QUANTITIES
                    if _is_told(reading, quantity) or f"{name}/{quantity}" in commands
                },
            }
            for name, reading in states.joints.items()
            if name not in followers
        ]
        robots.append({"name": namespace or "/", "joints": joints})
    return {"robots": robots}


def _is_told(reading: JointReading, quantity: str) -> bool:
    return math.isfinite(getattr(reading, quantity))


def _kinds(described: Description | None) -> tuple[dict[str, bool], set[str]]:
    """Return which joints slide, by name, and which follow others."""
    if described is None or described.robot is None:
        return {}, set()
    joints = described.robot.joints
    slides = {joint.name: joint.type.slides for joint in joints}
    return slides, {joint.name for joint in joints if joint.mimic is not None}


def _commands(snapshot: Snapshot, namespace: str) -> dict[str, tuple[str, bool]]:
    """Return the curve of each command interface that an active controller claims.

    Returns:
        Its name, and whether a command holds until the next one comes.
    """
    topics = {topic.name for topic in snapshot.topics}
    found: dict[str, tuple[str, bool]] = {}
    for controller in snapshot.controllers:
        if controller.namespace == namespace and controller.state == "active":
            found |= _commands_to(controller, topics)
    return found


_PLURALS = {"position": "positions", "velocity": "velocities", "effort": "effort"}


def _commands_to(controller: ListedController, topics: set[str]) -> dict[str, tuple[str, bool]]:
    prefix = f"{controller.namespace}/{controller.name}"
    interfaces = [(name, *name.rpartition("/")[::2]) for name in controller.claimed]
    if f"{prefix}/controller_state" in topics:
        return {
            name: (f"{prefix}/controller_state.reference.{_PLURALS[quantity]}[{joint}]", False)
            for name, joint, quantity in interfaces
            if quantity in _PLURALS
        }
    if f"{prefix}/commands" in topics:
        return {
            name: (f"{prefix}/commands.data[{index}]", True)
            for index, (name, _, _) in enumerate(interfaces)
        }
    return {}
