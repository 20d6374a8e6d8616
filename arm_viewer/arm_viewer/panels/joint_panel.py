"""Sliders that move the joints and follow them."""

import math
import random
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from html import escape
from typing import Any

from viser import GuiApi, GuiEvent

from arm_description.publishers.joint_state_merge import position_range
from arm_description.urdf.robot import Joint
from arm_viewer.channel import Browser, Channel, Message
from arm_viewer.joint_move import joint_drives
from arm_viewer.panels.panel import fill, in_order, note, show
from arm_viewer.requests import MoveJoints, Send
from arm_viewer.snapshot import Description, JointReading, Snapshot

TYPED_NUMBER = "typed_number"
"""Kind of a browser's message: a text typed beside a slider. The answer has its number."""
ROUNDING = 1e-9
"""How far beyond a limit a typed number may be, in rad or m; it counts as the limit."""
STEPS = 1000
STILL_S = 0.5
MAX_HOLD_S = 5.0
FOLLOW_S = 0.1
"""Time between two positions that a slider shows of a joint that moves."""
NO_DRIVE = "No active controller takes positions: the sliders only show them."
NAME_STYLE = "width:100%;max-width:0;white-space:nowrap;overflow:hidden;text-overflow:ellipsis"
NUMBER_STYLE = "text-align:right;vertical-align:top;white-space:nowrap;padding-left:1em"


@dataclass(frozen=True, slots=True)
class JointRange:
    """The joint's limits, including soft limits, in rad, or m for a prismatic joint."""

    name: str
    lower: float
    upper: float

    @property
    def centre(self) -> float:
        """0 if it is within the limits, else their middle, as in joint_state_publisher_gui."""
        return 0.0 if self.lower <= 0.0 <= self.upper else 0.5 * (self.lower + self.upper)

    @property
    def step(self) -> float:
        """The power of ten that divides the range into about a thousand steps."""
        return 10.0**-self._digits

    def nearest(self, position: float) -> float:
        """Return the nearest position within the limits, rounded to whole steps."""
        # Round to digits, not to multiples of the step, which would show as 0.7000000000000001.
        whole = round(position, self._digits)
        # Adding 0.0 turns -0.0 into 0.0, which is shown without a sign.
        return min(max(whole, self.lower), self.upper) + 0.0

    def followed(self, shown: float, position: float) -> float:
        """Return what a slider that shows `shown` is to show of a joint at `position`.

        A joint that trembles moves nothing; what is shown is at most 3/4 of a step off.
        """
        return shown if abs(position - shown) <= 0.75 * self.step else self.nearest(position)

    @property
    def _digits(self) -> int:
        """Number of decimals of a step; negative if a step is ten or more."""
        return -math.floor(math.log10((self.upper - self.lower) / STEPS))


def joint_ranges(joints: Iterable[Joint]) -> tuple[JointRange, ...]:
    """Return the ranges of the joints that a slider can move.

    These have one degree of freedom and room to move; a mimic joint follows its leader instead.
    """
    ranges = []
    for joint in joints:
        if joint.mimic is not None or not joint.type.is_scalar:
            continue
        lower, upper = position_range(joint)
        if math.isfinite(upper - lower) and lower < upper:
            ranges.append(JointRange(joint.name, lower, upper))
    return tuple(ranges)


class HeldSlider:
    """Decides whether a slider shows the position of its joint. One thread at a time.

    While the user drags the slider, and until the joint has set off and stopped, the slider stays
    where the user put it; otherwise it would jump back to the present position. Afterwards it shows
    the position of the joint. After `MAX_HOLD_S` it does so even if the joint still moves, or has
    never moved: how soon a joint sets off depends on the load of two machines and a network.
    """

    def __init__(self, resolution: float) -> None:
        """Ignore movements smaller than `resolution` (rad or m)."""
        self._resolution = resolution
        self._held_from_s = -math.inf
        self._target = math.nan
        self._moved_s = -math.inf
        self._position = math.nan

    def hold(self, target: float, now_s: float) -> None:
        """Record that the user has moved the slider to a position."""
        self._target = target
        self._held_from_s = now_s

    def shown(self, position: float, now_s: float) -> float | None:
        """Return what the slider should show of its joint's position; None to leave it as it is."""
        if not math.isfinite(position):
            return None
        if not abs(position - self._position) < self._resolution:
            self._position = position
            self._moved_s = now_s
        return None if self.is_held(now_s) else position

    def is_held(self, now_s: float) -> bool:
        """Return whether the slider stays where the user put it."""
        has_started = self._moved_s > self._held_from_s
        is_there = abs(self._position - self._target) < self._resolution
        still_s = now_s - max(self._moved_s, self._held_from_s)
        rests = (has_started or is_there) and still_s >= STILL_S
        return now_s - self._held_from_s < MAX_HOLD_S and not rests


class _MimicTable:
    """A line for each mimic joint, which no slider moves: its leader and its position."""

    def __init__(self, gui: GuiApi, joints: Iterable[Joint]) -> None:
        """Create the table in the open container; it is hidden if there are no mimic joints."""
        self._leaders = {j.name: j.mimic.joint for j in joints if j.mimic is not None}
        self._table = gui.add_html("", visible=bool(self._leaders))

    def update(self, readings: Mapping[str, JointReading]) -> None:
        """Show the positions of the mimic joints."""
        rows = "".join(
            f'<tr><td style="{NAME_STYLE}" title="{escape(name)} follows {escape(leader)}">'
            f'{escape(name)}<span style="opacity:0.6"> follows {escape(leader)}</span></td>'
            f'<td style="{NUMBER_STYLE}">{_position(readings.get(name))}</td></tr>'
            for name, leader in self._leaders.items()
        )
        table = (
            '<table style="font-size:0.75rem;margin:0.5em 0.75em;width:calc(100% - 1.5em);'
            f'font-variant-numeric:tabular-nums">{rows}</table>'
        )
        fill(self._table, table if rows else "")


def _position(reading: JointReading | None) -> str:
    if reading is None or not math.isfinite(reading.position):
        return ""
    # Adding 0.0 turns -0.0 into 0.0.
    return f"{round(reading.position, 3) + 0.0:.3f}"


class JointPanel:
    """A group of sliders for each robot."""

    def __init__(self, channel: Channel, send: Send) -> None:
        """Take typed numbers from the channel, and send moves with `send`."""
        self._channel = channel
        self._send = send
        self._groups: dict[str, _RobotSliders] = {}

    def build(self, gui: GuiApi) -> None:
        """Create the folder for the sliders, which appear with the robots."""
        self._channel.on(TYPED_NUMBER, self._take_typed)
        self._gui = gui
        self._place = gui.add_folder(None)

    def update(self, snapshot: Snapshot) -> None:
        """Follow the joints, and add and remove robots."""
        for topic in self._groups.keys() - snapshot.descriptions.keys():
            self._groups.pop(topic).remove()
        for topic, description in snapshot.descriptions.items():
            group = self._groups.get(topic)
            if group is None or group.description is not description:
                if group is not None:
                    group.remove()
                with self._place:
                    group = self._groups[topic] = _RobotSliders(self._gui, description, self._send)
            group.update(snapshot)

    def _take_typed(self, message: Message, browser: Browser) -> None:
        number = int(message.number("number"))
        problem = self._move_typed(message.text("slider"), message.text("text"))
        browser.send(TYPED_NUMBER, {"number": number, "problem": problem})

    def _move_typed(self, slider: str, text: str) -> str:
        """Move a joint to the number typed beside its slider; return the problem, or ""."""
        for group in self._groups.values():
            found = group.slider(slider)
            if found is not None:
                return found.take_typed(text)
        return "this joint is no longer there"


class _RobotSliders:
    """The sliders of one robot, and the buttons that move them all."""

    def __init__(self, gui: GuiApi, description: Description, send: Send) -> None:
        self.description = description
        self._send = send
        joints = () if description.robot is None else description.robot.joints
        ranges = joint_ranges(joints)
        title = f"Joints of {description.namespace}" if description.namespace else "Joints"
        self._folder = gui.add_folder(title, visible=bool(ranges))
        with self._folder:
            self._sliders = [_JointSlider(gui, joint, self._move) for joint in ranges]
            self._mimics = _MimicTable(gui, joints)
            self._buttons = gui.add_button_group("All", ("Center", "Randomize"), visible=False)
            self._hint = gui.add_html(note(NO_DRIVE), visible=False)
        self._buttons.on_click(in_order(self._move_all))

    def update(self, snapshot: Snapshot) -> None:
        namespace = self.description.namespace
        displays = namespace in snapshot.displayed
        drives = joint_drives(snapshot.controllers, namespace)
        driven = {joint for drive in drives for joint in drive.joints}
        readings = snapshot.readings(namespace)
        for slider in self._sliders:
            slider.update(readings, displays or slider.range.name in driven)
        self._mimics.update(readings)
        show(self._buttons, displays)
        show(self._hint, not (displays or driven))

    def slider(self, identifier: str) -> "_JointSlider | None":
        return next((s for s in self._sliders if s.identifier == identifier), None)

    def remove(self) -> None:
        self._folder.remove()

    def _move(self) -> None:
        # Includes joints that are still moving; without their targets they would stop.
        held = {slider.range.name: slider.value for slider in self._sliders if slider.is_held()}
        self._send(MoveJoints(self.description.namespace, held))

    def _move_all(self, event: GuiEvent[Any]) -> None:
        ranges = [slider.range for slider in self._sliders]
        if event.target.value == "Center":
            positions = {joint.name: joint.centre for joint in ranges}
        else:
            positions = {joint.name: random.uniform(joint.lower, joint.upper) for joint in ranges}
        self._send(MoveJoints(self.description.namespace, positions))


class _JointSlider:
    """One joint's slider."""

    def __init__(self, gui: GuiApi, joint: JointRange, move: Callable[[], None]) -> None:
        self.range = joint
        self._move = move
        self._held = HeldSlider(joint.step)
        self._followed_s = -math.inf
        self._handle = gui.add_slider(
            joint.name,
            min=joint.lower,
            max=joint.upper,
            step=joint.step,
            initial_value=joint.centre,
            marks=tuple((end, f"{end:.2f}") for end in (joint.lower, joint.upper)),
        )
        self._handle.on_update(in_order(self._moved))

    @property
    def value(self) -> float:
        """The slider's value, rad or m."""
        return self._handle.value

    @property
    def identifier(self) -> str:
        """The slider's identifier in the browser's document."""
        return self._handle._impl.uuid  # pyright: ignore[reportPrivateUsage]

    def take_typed(self, text: str) -> str:
        """Move the joint to the position in a text; return the problem, or ""."""
        if self._handle.disabled:
            return f"no active controller takes positions of '{self.range.name}'"
        try:
            position = number_typed(text, self.range.name, self.range.lower, self.range.upper)
        except ValueError as error:
            return str(error)
        self._held.hold(position, time.monotonic())
        self._handle.value = position
        self._move()
        return ""

    def is_held(self) -> bool:
        """Return whether the slider stays where the user put it."""
        return self._held.is_held(time.monotonic())

    def update(self, readings: Mapping[str, JointReading], driven: bool) -> None:
        """Show the joint's position, and whether it can be moved."""
        if self._handle.disabled == driven:
            self._handle.disabled = not driven
        reading = readings.get(self.range.name)
        if reading is None:
            return
        now_s = time.monotonic()
        shown = self._held.shown(reading.position, now_s)
        if shown is None or now_s - self._followed_s < FOLLOW_S:
            return
        followed = self.range.followed(self._handle.value, shown)
        if followed != self._handle.value:
            self._followed_s = now_s
            self._handle.value = followed

    def _moved(self, event: GuiEvent[Any]) -> None:
        # Without a client the change came from `update`, which must not move the joint.
        if event.client_id is not None:
            self._held.hold(self.value, time.monotonic())
            self._move()


def number_typed(text: str, name: str, lower: float, upper: float) -> float:
    """Return the number in a text.

    Raises:
        ValueError: the text is not a number, or the number is not between `lower` and `upper`;
            the message is a sentence.
    """
    try:
        number = float(text)
    except ValueError:
        raise ValueError(f"'{text}' is not a number; write it like -0.5 or 1e-2") from None
    # Also rejects NaN.
    if not lower - ROUNDING <= number <= upper + ROUNDING:
        raise ValueError(f"'{name}' goes from {lower:g} to {upper:g}; {number:g} is outside")
    return min(max(number, lower), upper)
