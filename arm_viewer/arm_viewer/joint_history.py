"""The last seconds of joints: what they did, and what they were told."""

import math
from collections import deque
from collections.abc import Mapping
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from arm_viewer.snapshot import JointReading

GAP_S = 0.5
"""Between readings farther apart than this there is no line."""


class Quantity(Enum):
    """What is measured of a joint; the value is ros2_control's name of the interface."""

    POSITION = "position"
    VELOCITY = "velocity"
    EFFORT = "effort"


_QUANTITIES = tuple(Quantity)


class JointHistory:
    """Readings and commands of a set of joints; one thread at a time.

    Attributes:
        joints: their names, in the order of all columns.
    """

    def __init__(self, window_s: float) -> None:
        """Keep what is not older than `window_s`."""
        self.joints: tuple[str, ...] = ()
        self._window_s = window_s
        self._times: deque[float] = deque()
        # Each of shape (2, 3, n): readings and commands, by quantity, by joint.
        self._rows: deque[NDArray[np.float64]] = deque()

    def add(
        self, time_s: float, readings: Mapping[str, JointReading], commands: Mapping[str, float]
    ) -> None:
        """Add what was read at a time, later than all before. Other joints begin anew.

        Args:
            time_s: when it was received.
            readings: of every joint.
            commands: by command interface, "j0/position".
        """
        joints = tuple(readings)
        if joints != self.joints:
            self.joints = joints
            self._times.clear()
            self._rows.clear()
        if self._times and time_s - self._times[-1] > GAP_S:
            self._append(self._times[-1], np.full((2, len(_QUANTITIES), len(joints)), math.nan))
        self._append(time_s, _row(readings, commands))
        while self._times[0] < time_s - self._window_s:
            self._times.popleft()
            self._rows.popleft()

    def table(
        self, quantity: Quantity, now_s: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Return ages, readings and commands.

        Returns:
            times before `now_s`, so negative, oldest first, in s (m,); readings (n, m); commands
            (n, m). What was not said is NaN.
        """
        ages = np.array(self._times) - now_s
        if not self._rows:
            nothing = np.empty((len(self.joints), 0))
            return ages, nothing, nothing
        values = np.stack(self._rows, axis=-1)[:, _QUANTITIES.index(quantity)]
        return ages, values[0], values[1]

    def _append(self, time_s: float, row: NDArray[np.float64]) -> None:
        self._times.append(time_s)
        self._rows.append(row)


def _row(
    readings: Mapping[str, JointReading], commands: Mapping[str, float]
) -> NDArray[np.float64]:
    read = [[getattr(r, q.value) for r in readings.values()] for q in _QUANTITIES]
    told = [[commands.get(f"{j}/{q.value}", math.nan) for j in readings] for q in _QUANTITIES]
    row = np.array([read, told])
    # One infinity, and the browser's chart has no scale.
    row[np.isinf(row)] = math.nan
    return row
