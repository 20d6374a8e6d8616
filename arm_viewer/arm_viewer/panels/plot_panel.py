"""Plots of the joints over the last seconds: position, velocity and effort, commands dashed."""

import itertools
import math
from collections.abc import Callable, Mapping
from enum import Enum
from html import escape

import numpy as np
from numpy.typing import NDArray
from viser import GuiApi, GuiUplotHandle, uplot

from arm_viewer.snapshot import Description, JointReading, JointStates, Snapshot

GAP_S = 0.5
"""Readings farther apart than this are not joined by a line."""
FIRST_ROOM = 64
"""Number of readings that a new history has room for."""


class Quantity(Enum):
    """A measured quantity of a joint; the value is ros2_control's interface name."""

    POSITION = "position"
    VELOCITY = "velocity"
    EFFORT = "effort"


_QUANTITIES = tuple(Quantity)


class JointHistory:
    """Readings and commands of a set of joints; use it from one thread at a time.

    Attributes:
        joints: names of the joints, in the order of the rows of `table`.
    """

    def __init__(self, window_s: float) -> None:
        """Keep readings up to `window_s` old."""
        self._window_s = window_s
        self.clear()

    def add(
        self, time_s: float, readings: Mapping[str, JointReading], commands: Mapping[str, float]
    ) -> None:
        """Add readings with a later time than all before; a new set of joints restarts the history.

        Args:
            time_s: time of reception.
            readings: readings by joint.
            commands: commands by command interface, such as "j0/position".
        """
        joints = tuple(readings)
        if joints != self.joints:
            self.clear()
            self.joints = joints
            self._values = np.empty((2, len(_QUANTITIES), len(joints), FIRST_ROOM))
        if self._end > self._begin and time_s - self._times[self._end - 1] > GAP_S:
            self._append(float(self._times[self._end - 1]), math.nan)
        self._append(time_s, _row(readings, commands))
        while self._times[self._begin] < time_s - self._window_s:
            self._begin += 1

    def clear(self) -> None:
        """Forget everything, including the joints."""
        self.joints: tuple[str, ...] = ()
        self._times = np.empty(FIRST_ROOM)
        # Readings and commands, by quantity, by joint, by time; valid from `_begin` to `_end`.
        self._values = np.empty((2, len(_QUANTITIES), 0, FIRST_ROOM))
        self._begin = self._end = 0

    def table(
        self, quantity: Quantity, now_s: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Return ages, readings and commands.

        Returns:
            Times relative to `now_s` in s, so negative, oldest first (m,); readings (n, m);
            commands (n, m). Missing values are NaN.
        """
        kept = slice(self._begin, self._end)
        values = self._values[:, _QUANTITIES.index(quantity), :, kept]
        return self._times[kept] - now_s, values[0].copy(), values[1].copy()

    def _append(self, time_s: float, row: NDArray[np.float64] | float) -> None:
        if self._end == len(self._times):
            self._make_room()
        self._times[self._end] = time_s
        self._values[..., self._end] = row
        self._end += 1

    def _make_room(self) -> None:
        """Move what is valid to the front of arrays of twice its size."""
        count = self._end - self._begin
        times, values = self._times[self._begin :], self._values[..., self._begin :]
        self._times = np.empty(max(2 * count, FIRST_ROOM))
        self._values = np.empty((*values.shape[:-1], len(self._times)))
        self._times[:count], self._values[..., :count] = times, values
        self._begin, self._end = 0, count


def _row(
    readings: Mapping[str, JointReading], commands: Mapping[str, float]
) -> NDArray[np.float64]:
    measured = [[getattr(r, q.value) for r in readings.values()] for q in _QUANTITIES]
    commanded = [[commands.get(f"{j}/{q.value}", math.nan) for j in readings] for q in _QUANTITIES]
    row = np.array([measured, commanded])
    # A single infinity would leave the browser's chart without a scale.
    row[np.isinf(row)] = math.nan
    return row


DEFAULT_TOPIC: str = "/joint_states"
WINDOW_S = 10.0
PERIOD_S = 0.1
"""Time between two updates of the charts."""
HEIGHT = 116
UNITS = {
    Quantity.POSITION: "rad, m",
    Quantity.VELOCITY: "rad/s, m/s",
    Quantity.EFFORT: "N m, N",
}
MIN_SPANS = {Quantity.POSITION: 0.1, Quantity.VELOCITY: 0.2, Quantity.EFFORT: 0.2}
"""Smallest vertical range of a chart, in UNITS; less would show the noise of joints at rest."""
COLOURS = (
    *("#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd", "#8c564b", "#e377c2", "#7f7f7f"),
    *("#bcbd22", "#17becf", "#1a2a6c", "#f4b400", "#00695c", "#ff5fa2", "#5d4037", "#76d7c4"),
)
LEGEND_STYLE = "font-size:0.7rem;line-height:1.5;padding:0 0.75em 0.5em"
_TEXT, _GRID = "#495057", "#dee2e6"


class PlotPanel:
    """Charts of the joints of one topic, by default the first robot's.

    Joints that follow others are left out: their curves say nothing new.
    """

    def __init__(self, is_watched: Callable[[], bool]) -> None:
        """Draw while `is_watched` returns whether any browser is connected."""
        self._is_watched = is_watched
        self._history = JointHistory(WINDOW_S)
        self._charts: tuple[_Chart, ...] = ()
        self._seen: JointStates | None = None
        self._drawn_s = -math.inf
        self._explained = ""

    def build(self, gui: GuiApi) -> None:
        """Create the charts."""
        self._topic = gui.add_dropdown("Joints of", (DEFAULT_TOPIC,), visible=False)
        self._frozen = gui.add_checkbox("Freeze", False, hint="stop the charts to look at them")
        self._charts = tuple(_Chart(gui, quantity) for quantity in Quantity)
        self._legend = gui.add_html("")

    def update(self, snapshot: Snapshot) -> None:
        """Store new readings, and redraw the charts ten times a second."""
        self._offer(tuple(sorted(snapshot.joint_states)))
        states = snapshot.joint_states.get(self._topic.value)
        if states is None:
            self._history.clear()
        elif states is not self._seen:
            self._seen = states
            namespace = self._topic.value.removesuffix(DEFAULT_TOPIC)
            followers = _followers(snapshot.descriptions.get(f"{namespace}/robot_description"))
            leaders = {name: r for name, r in states.joints.items() if name not in followers}
            commands = snapshot.commands.get(namespace, {})
            self._history.add(states.received_s, leaders, commands)
        is_due = snapshot.made_s - self._drawn_s >= PERIOD_S and not self._frozen.value
        if is_due and self._is_watched():
            self._drawn_s = snapshot.made_s
            for chart in self._charts:
                chart.draw(self._history, snapshot.made_s)
            self._explain({joint for chart in self._charts for joint in chart.commanded})

    def _explain(self, commanded: set[str]) -> None:
        """Say once below all charts which colour is which joint's."""
        text = _legend(self._history.joints, bool(commanded))
        if text != self._explained:
            self._explained = text
            self._legend.content = text

    def _offer(self, topics: tuple[str, ...]) -> None:
        topics = topics or (DEFAULT_TOPIC,)
        if topics != self._topic.options:
            self._topic.options = topics
            self._topic.visible = len(topics) > 1


def _followers(description: Description | None) -> frozenset[str]:
    if description is None or description.robot is None:
        return frozenset()
    return frozenset(joint.name for joint in description.robot.joints if joint.mimic is not None)


def _legend(joints: tuple[str, ...], has_commands: bool) -> str:
    entries = "".join(
        f'<span style="white-space:nowrap;margin-right:0.9em"><span style="color:{colour}">'
        f"&#9632;</span> {escape(joint)}</span> "
        for joint, colour in zip(joints, itertools.cycle(COLOURS), strict=False)
    )
    dashed = '<span style="white-space:nowrap">dashed: command</span>' if has_commands else ""
    return f'<div style="{LEGEND_STYLE}">{entries}{dashed}</div>'


class _Chart:
    """The chart of one quantity."""

    def __init__(self, gui: GuiApi, quantity: Quantity) -> None:
        self._quantity = quantity
        self._lines: tuple[tuple[str, bool], ...] = ()
        self._joints: tuple[str, ...] = ()
        empty = np.empty(0)
        self._plot: GuiUplotHandle = gui.add_uplot(
            data=(empty, empty),
            series=(uplot.Series(), _invisible()),
            title=f"{quantity.value} ({UNITS[quantity]})",
            scales={"x": uplot.Scale(time=False, auto=False, range=(-WINDOW_S, 0.0))},
            axes=(_axis(), _axis()),
            # One below all charts says it once.
            legend=uplot.Legend(show=False),
            height=HEIGHT,
        )

    @property
    def commanded(self) -> tuple[str, ...]:
        """The joints whose commands are drawn."""
        return tuple(joint for joint, is_command in self._lines if is_command)

    def draw(self, history: JointHistory, now_s: float) -> None:
        ages, readings, commands = history.table(self._quantity, now_s)
        measured, commanded = (~np.isnan(values).all(axis=1) for values in (readings, commands))
        lines = tuple((history.joints[index], False) for index in np.flatnonzero(measured))
        lines += tuple((history.joints[index], True) for index in np.flatnonzero(commanded))
        if not lines:
            if self._lines:
                self._lines = ()
                self._plot.data = (np.empty(0), np.empty(0))
                self._plot.series = (uplot.Series(), _invisible())
            return
        if (lines, history.joints) != (self._lines, self._joints):
            self._lines, self._joints = lines, history.joints
            drawn = map(_series, lines, _colours(lines, history.joints))
            self._plot.series = (uplot.Series(label="s"), *drawn, _invisible())
        # Before the first command, the dashed line follows the reading.
        readings = interpolated(ages, readings)
        commands = interpolated(ages, np.where(np.isnan(commands), readings, commands))
        shown = np.concatenate([readings[measured], commands[commanded]])
        self._plot.data = (ages, *shown, span_row(shown, MIN_SPANS[self._quantity]))


def interpolated(ages: NDArray[np.float64], rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return rows with NaN interpolated linearly between their neighbours.

    A single NaN would leave the browser's chart without a scale, and it would draw nothing.

    Args:
        ages: ascending (m,).
        rows: (n, m); a row of NaN only is unchanged.
    """
    if not np.isnan(rows).any():
        return rows
    filled = rows.copy()
    for row in filled:
        known = ~np.isnan(row)
        if known.any():
            row[~known] = np.interp(ages[~known], ages[known], row[known])
    return filled


def span_row(rows: NDArray[np.float64], min_span: float) -> NDArray[np.float64]:
    """Return a row (m,) that alternates around the middle of `rows` and spans at least `min_span`.

    The browser's chart scales to its data and has no minimum range, so this invisible row sets one.

    Args:
        rows: the visible rows (n, m), n and m at least 1, without NaN.
        min_span: smallest range in the rows' unit.
    """
    low, high = rows.min(), rows.max()
    reach = max(high - low, min_span) / 2.0
    row = np.full(rows.shape[1], (low + high) / 2.0 - reach)
    row[1::2] += 2.0 * reach
    return row


def _invisible() -> uplot.Series:
    """Return an invisible series that still counts for the scale."""
    # Without a label the legend would say "Value".
    return uplot.Series(
        label="\N{NO-BREAK SPACE}", stroke="transparent", width=0, points={"show": False}
    )


def _axis() -> uplot.Axis:
    return uplot.Axis(
        stroke=_TEXT,
        grid=uplot.Axis_Grid(stroke=_GRID, width=1),
        ticks=uplot.Axis_Ticks(stroke=_GRID, width=1),
        size=50,
    )


def _colours(lines: tuple[tuple[str, bool], ...], joints: tuple[str, ...]) -> list[str]:
    """Return a colour for each line, the same for the reading and the command of a joint."""
    return [COLOURS[joints.index(joint) % len(COLOURS)] for joint, _ in lines]


def _series(line: tuple[str, bool], colour: str) -> uplot.Series:
    joint, is_command = line
    if is_command:
        return uplot.Series(label=f"{joint} cmd", stroke=colour, width=1, dash=(6, 4))
    return uplot.Series(label=joint, stroke=colour, width=1.5)
