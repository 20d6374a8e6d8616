"""When which camera takes a picture, or another sensor a reading, in simulation time."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

TOLERANCE_S = 1e-6
"""A time that is a sum of steps may fall short of the number that it stands for."""


@dataclass(frozen=True, slots=True)
class FrameDue:
    """One picture to take.

    Attributes:
        camera: index of the camera.
        number: k of a frame whose nominal time is k / rate; jumps back when time does.
        serial: how many frames of this camera were due before; has no gaps.
    """

    camera: int
    number: int
    serial: int


class FrameSchedule:
    """Decides at each tick which cameras take a picture. One thread.

    Frame k of a camera at f Hz is due at the first tick at or after k / f: the mean rate is
    exact whatever the tick rate. A tick that passes several frames of one camera takes the last.
    When time jumps back (a reset), the schedule starts again from there.
    """

    def __init__(self, rates_hz: Sequence[float]) -> None:
        self._rates_hz = tuple(rates_hz)
        self._serials = [0] * len(self._rates_hz)
        self._numbers = [-1] * len(self._rates_hz)
        self._last_s = -math.inf
        self._next_s = 0.0 if self._rates_hz else math.inf

    def nothing_due(self, time_s: float) -> bool:
        """Return quickly whether no camera takes a picture at this tick."""
        if self._last_s <= time_s < self._next_s:
            self._last_s = time_s
            return True
        return False

    def take_due(self, time_s: float) -> tuple[FrameDue, ...]:
        """Return the frames due at this tick, each once."""
        if time_s < self._last_s:
            self._numbers = [-1] * len(self._rates_hz)
        self._last_s = time_s
        due: list[FrameDue] = []
        self._next_s = math.inf
        for camera, rate_hz in enumerate(self._rates_hz):
            number = math.floor((time_s + TOLERANCE_S) * rate_hz)
            if number > self._numbers[camera]:
                self._numbers[camera] = number
                due.append(FrameDue(camera, number, self._serials[camera]))
                self._serials[camera] += 1
            next_s = (self._numbers[camera] + 1) / rate_hz - TOLERANCE_S
            if next_s < self._next_s:
                self._next_s = next_s
        return tuple(due)
