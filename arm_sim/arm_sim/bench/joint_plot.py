"""Draw the states of joints over time as a picture."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from arm_sim.bench.history import QUANTITIES, StateHistory
from arm_sim.injected_faults import FaultSpan

Picture = NDArray[np.uint8]
Colour = tuple[int, int, int]

WIDTH, PANEL_HEIGHT = 960, 240
LEFT, RIGHT, TOP, BOTTOM = 90, 150, 28, 28
LEGEND_LINE = 20
LINES = 12
"""How many joints the legend of a panel has room for."""
FONT, FONT_SIZE = cv2.FONT_HERSHEY_SIMPLEX, 0.42
INK, GRID, FAULT = (60, 60, 60), (225, 225, 225), (225, 235, 255)
COLOURS: Sequence[Colour] = (
    (180, 119, 31), (14, 127, 255), (44, 160, 44), (40, 39, 214), (189, 103, 148), (75, 86, 140),
    (194, 119, 227), (127, 127, 127), (34, 189, 188), (207, 190, 23),
)  # fmt: skip
"""Blue, green and red of the lines."""


def save_plot(history: StateHistory, path: Path, faults: Sequence[FaultSpan] = ()) -> None:
    """Write a picture with a panel each for positions, velocities and efforts.

    The history has at least one state; the faults are shown as shaded spans.

    Raises:
        OSError: the file cannot be written.
    """
    times_s = history.times_s
    span = (float(times_s[0]), max(float(times_s[-1]), float(times_s[0]) + 1e-3))
    panels = [_panel(history, quantity, span, faults) for quantity in QUANTITIES]
    _, encoded = cv2.imencode(".png", np.vstack(panels))
    path.write_bytes(encoded.tobytes())


def _panel(
    history: StateHistory,
    quantity: str,
    span: tuple[float, float],
    faults: Sequence[FaultSpan],
) -> Picture:
    picture: Picture = np.full((PANEL_HEIGHT, WIDTH, 3), 255, np.uint8)
    times_s = history.times_s
    values = history.of(quantity)[: len(times_s)]
    guides = [guide for guide in history.guides if guide.quantity == quantity]
    axes = _Axes(span, _range(values, [guide.value for guide in guides]))
    for fault in faults:
        left, right = axes.x(max(fault.began_s, span[0])), axes.x(min(fault.ended_s, span[1]))
        cv2.rectangle(picture, (left, TOP), (right, PANEL_HEIGHT - BOTTOM), FAULT, -1)
        if quantity == QUANTITIES[0]:
            _text(picture, fault.name, (left + 2, TOP + 12))
    axes.draw(picture, f"{quantity} [{_units(history, quantity)}] over time [s]")
    for index, name in enumerate(history.names):
        colour = COLOURS[index % len(COLOURS)]
        for run in _finite_runs(values[:, index]):
            points = np.column_stack([axes.x(times_s[run]), axes.y(values[run, index])])
            cv2.polylines(picture, [points], False, colour, 1, cv2.LINE_AA)
        for guide in guides:
            if guide.joint == name and np.isfinite(guide.value):
                _dashes(picture, int(axes.y(guide.value)), colour)
        if index < LINES:
            label = name if len(name) <= 18 else f"{name[:8]}..{name[-8:]}"
            _text(picture, label, (WIDTH - RIGHT + 10, TOP + LEGEND_LINE * index + 8), colour)
    return picture


class _Axes:
    """The frame of a panel: times and values as pixels."""

    def __init__(self, span: tuple[float, float], limits: tuple[float, float]) -> None:
        self._span, self._limits = span, limits

    def x(self, times_s: Any) -> Any:
        first, last = self._span
        return _pixel(LEFT + (times_s - first) / (last - first) * (WIDTH - LEFT - RIGHT))

    def y(self, values: Any) -> Any:
        low, high = self._limits
        bottom = PANEL_HEIGHT - BOTTOM
        return _pixel(bottom - (values - low) / (high - low) * (bottom - TOP))

    def draw(self, picture: Picture, title: str) -> None:
        bottom, right = PANEL_HEIGHT - BOTTOM, WIDTH - RIGHT
        for value in _ticks(*self._limits):
            cv2.line(picture, (LEFT, self.y(value)), (right, self.y(value)), GRID, 1)
            _text(picture, f"{value:.6g}", (8, self.y(value) + 4))
        for time_s in _ticks(*self._span):
            cv2.line(picture, (self.x(time_s), TOP), (self.x(time_s), bottom), GRID, 1)
            _text(picture, f"{time_s:.6g}", (self.x(time_s) - 8, bottom + 16))
        cv2.rectangle(picture, (LEFT, TOP), (right, bottom), INK, 1)
        _text(picture, title, (LEFT, TOP - 10))


def _pixel(value: Any) -> Any:
    return np.rint(value).astype(np.int32) if isinstance(value, np.ndarray) else round(value)


def _range(values: NDArray[np.float64], guides: Sequence[float]) -> tuple[float, float]:
    """Return the lowest and highest value to show, with a margin."""
    shown = np.concatenate([values.ravel(), np.array(guides)])
    shown = shown[np.isfinite(shown)]
    low, high = (float(shown.min()), float(shown.max())) if len(shown) else (0.0, 0.0)
    margin = 0.08 * (high - low) or max(1e-3, 0.1 * abs(high))
    return low - margin, high + margin


def _ticks(low: float, high: float) -> NDArray[np.float64]:
    """Return round values in a range, up to about six."""
    rough = (high - low) / 6
    power = 10.0 ** np.floor(np.log10(rough))
    step = next(power * factor for factor in (1, 2, 5, 10) if power * factor >= rough)
    return np.arange(np.ceil(low / step), np.floor(high / step) + 1) * step + 0.0


def _finite_runs(values: NDArray[np.float64]) -> list[NDArray[np.intp]]:
    """Return the indices of values without gaps; a NaN is a gap."""
    finite = np.flatnonzero(np.isfinite(values))
    runs = np.split(finite, np.flatnonzero(np.diff(finite) > 1) + 1)
    return [run for run in runs if len(run)]


def _dashes(picture: Picture, y: int, colour: Colour) -> None:
    for x in range(LEFT, WIDTH - RIGHT, 10):
        cv2.line(picture, (x, y), (x + 4, y), colour, 1)


def _units(history: StateHistory, quantity: str) -> str:
    units = dict.fromkeys(history.unit(name, quantity) for name in history.names)
    return ", ".join(filter(None, units)) or "SI"


def _text(picture: Picture, text: str, where: tuple[int, int], colour: Colour = INK) -> None:
    cv2.putText(picture, text, where, FONT, FONT_SIZE, colour, 1, cv2.LINE_AA)
