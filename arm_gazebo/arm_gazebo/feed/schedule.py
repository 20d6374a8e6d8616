"""When each camera takes a picture and each sensor a reading, in simulation time, and how many."""

import math
from collections.abc import Sequence
from typing import Any

from arm_control.loop.schedule import Schedule
from arm_node.frozen import frozen


@frozen
class StreamCount:
    """A camera's or a sensor's figures since the start.

    Attributes:
        name: the camera's name, or the sensor's topic.
        kind: "camera" or "sensor".
        rate_hz: the rate asked for, per second of simulation time.
        due: how many were due; those that nobody subscribes to count as well.
        published: how many were published.
        dropped: how many were lost for lack of time.
    """

    name: str
    kind: str
    rate_hz: float
    due: int
    published: int
    dropped: int


@frozen
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

    Attributes:
        serials: for each camera, how many frames were due so far; read it only.
    """

    def __init__(self, rates_hz: Sequence[float]) -> None:
        self._schedules = tuple(Schedule(rate_hz, 0.0) for rate_hz in rates_hz)
        self.serials = [0] * len(self._schedules)
        self._last_s = -math.inf
        self._next_s = 0.0 if self._schedules else math.inf

    def __len__(self) -> int:
        return len(self._schedules)

    def restart(self) -> None:
        """Start again: the next tick takes every picture that is due."""
        self._last_s, self._next_s = math.inf, 0.0 if self._schedules else math.inf

    def save_state(self) -> tuple[Any, ...]:
        """Return which frames are due next. Serials count what was sent and are not part of it."""
        return self._last_s, self._next_s, [schedule.save_state() for schedule in self._schedules]

    def load_state(self, state: tuple[Any, ...]) -> None:
        """Continue from a saved state."""
        self._last_s, self._next_s, schedules = state
        for schedule, saved in zip(self._schedules, schedules, strict=True):
            schedule.load_state(saved)

    def nothing_due(self, time_s: float) -> bool:
        """Return quickly whether no camera takes a picture at this tick."""
        if self._last_s <= time_s < self._next_s:
            self._last_s = time_s
            return True
        return False

    def take_due(self, time_s: float) -> tuple[FrameDue, ...]:
        """Return the frames due at this tick, each once."""
        has_gone_back = time_s < self._last_s
        self._last_s = time_s
        due: list[FrameDue] = []
        for camera, schedule in enumerate(self._schedules):
            if has_gone_back:
                schedule.restart()
            if schedule.is_due(time_s):
                due.append(FrameDue(camera, schedule.number, self.serials[camera]))
                self.serials[camera] += 1
        self._next_s = min((schedule.next_s for schedule in self._schedules), default=math.inf)
        return tuple(due)
