"""The joints over the last seconds: position, velocity and effort, and the commands dashed."""

import math

import numpy as np
from numpy.typing import NDArray
from viser import GuiApi, GuiUplotHandle, uplot

from arm_viewer.joint_history import JointHistory, Quantity
from arm_viewer.snapshot import JointStates, Snapshot

DEFAULT_TOPIC: str = "/joint_states"
WINDOW_S = 10.0
PERIOD_S = 0.1
"""Between two pictures of the charts."""
HEIGHT = 150
UNITS = {
    Quantity.POSITION: "rad, m",
    Quantity.VELOCITY: "rad/s, m/s",
    Quantity.EFFORT: "N m, N",
}
LEAST_SPANS = {Quantity.POSITION: 0.1, Quantity.VELOCITY: 0.2, Quantity.EFFORT: 0.2}
"""What a chart shows from bottom to top at least, in UNITS: less is noise of joints at rest."""
COLOURS = ("#4dabf7", "#ffa94d", "#69db7c", "#ff8787", "#b197fc", "#f783ac", "#ffd43b", "#66d9e8")
_TEXT, _GRID = "#adb5bd", "#373a40"


class PlotPanel:
    """Charts of the joints of one topic, that of the first robot unless another is chosen."""

    def __init__(self) -> None:
        self._history = JointHistory(WINDOW_S)
        self._charts: tuple[_Chart, ...] = ()
        self._seen: JointStates | None = None
        self._drawn_s = -math.inf

    def build(self, gui: GuiApi) -> None:
        """Make the charts."""
        self._topic = gui.add_dropdown("Joints of", (DEFAULT_TOPIC,), visible=False)
        self._still = gui.add_checkbox(
            "Hold still", False, hint="charts do not go on, to be looked at"
        )
        self._charts = tuple(_Chart(gui, quantity) for quantity in Quantity)

    def update(self, snapshot: Snapshot) -> None:
        """Note what is new; draw now and then."""
        self._offer(tuple(sorted(snapshot.joint_states)))
        states = snapshot.joint_states.get(self._topic.value)
        if states is not None and states is not self._seen:
            self._seen = states
            told = snapshot.commands.get(self._topic.value.removesuffix(DEFAULT_TOPIC), {})
            self._history.add(states.received_s, states.joints, told)
        if snapshot.made_s - self._drawn_s >= PERIOD_S and not self._still.value:
            self._drawn_s = snapshot.made_s
            for chart in self._charts:
                chart.draw(self._history, snapshot.made_s)

    def _offer(self, topics: tuple[str, ...]) -> None:
        if topics and topics != self._topic.options:
            self._topic.options = topics
            self._topic.visible = len(topics) > 1


class _Chart:
    """The chart of one quantity."""

    def __init__(self, gui: GuiApi, quantity: Quantity) -> None:
        self._quantity = quantity
        self._lines: tuple[tuple[str, bool], ...] = ()
        nothing = np.empty(0)
        self._plot: GuiUplotHandle = gui.add_uplot(
            data=(nothing, nothing),
            series=(uplot.Series(), _unseen()),
            title=f"{quantity.value} ({UNITS[quantity]})",
            scales={"x": uplot.Scale(time=False, auto=False, range=(-WINDOW_S, 0.0))},
            axes=(_axis(), _axis()),
            # Live, it would say "--" of every line until the mouse is over the chart.
            legend=uplot.Legend(live=False),
            height=HEIGHT,
        )

    def draw(self, history: JointHistory, now_s: float) -> None:
        ages, readings, commands = history.table(self._quantity, now_s)
        read, told = (~np.isnan(values).all(axis=1) for values in (readings, commands))
        lines = tuple((history.joints[index], False) for index in np.flatnonzero(read))
        lines += tuple((history.joints[index], True) for index in np.flatnonzero(told))
        if not lines:
            return
        if lines != self._lines:
            self._lines = lines
            drawn = map(_series, lines, _colours(lines))
            self._plot.series = (uplot.Series(label="s"), *drawn, _unseen())
        # Until a joint is told something, its dashed line lies on what it did.
        did = unbroken(ages, readings)
        commands = unbroken(ages, np.where(np.isnan(commands), did, commands))
        shown = np.concatenate([did[read], commands[told]])
        self._plot.data = (ages, *shown, extent(shown, LEAST_SPANS[self._quantity]))


def unbroken(ages: NDArray[np.float64], rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return rows whose NaN are on the straight line between their neighbours.

    One NaN, and the browser's chart finds no scale and draws nothing at all.

    Args:
        ages: ascending (m,).
        rows: (n, m); those that are nothing but NaN stay so.
    """
    filled = rows.copy()
    for row in filled:
        said = ~np.isnan(row)
        if said.any():
            row[~said] = np.interp(ages[~said], ages[said], row[said])
    return filled


def extent(rows: NDArray[np.float64], least: float) -> NDArray[np.float64]:
    """Return a row (m,) that goes to and fro, at least `least` high, around the middle of `rows`.

    A scale of the browser's chart is as high as what it draws, and has no least height of its own.

    Args:
        rows: what is drawn (n, m), n and m at least 1, without NaN.
        least: in the rows' unit.
    """
    low, high = rows.min(), rows.max()
    reach = max(high - low, least) / 2.0
    row = np.full(rows.shape[1], (low + high) / 2.0 - reach)
    row[1::2] += 2.0 * reach
    return row


def _unseen() -> uplot.Series:
    """Return what draws nothing, but counts for the scale."""
    # Without a word of its own the legend would say "Value".
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


def _colours(lines: tuple[tuple[str, bool], ...]) -> list[str]:
    """Return a colour for each line, the same for what a joint does and what it is told."""
    joints = list(dict.fromkeys(joint for joint, _ in lines))
    return [COLOURS[joints.index(joint) % len(COLOURS)] for joint, _ in lines]


def _series(line: tuple[str, bool], colour: str) -> uplot.Series:
    joint, is_command = line
    if is_command:
        return uplot.Series(label=f"{joint} cmd", stroke=colour, width=1, dash=(6, 4))
    return uplot.Series(label=joint, stroke=colour, width=1.5)
