"""The position in a recording: play, pause, seek, speed."""

import math
from dataclasses import dataclass

MIN_SPEED, MAX_SPEED = 0.01, 100.0


@dataclass(slots=True)
class Playback:
    """A moment of a recording that moves on while it plays; one thread at a time.

    Attributes:
        length_s: length of the recording.
        time_s: the moment, from 0 to `length_s`.
        is_playing: whether it moves on.
        speed: recorded seconds a second.
        open_s: up to where there is something to show.
        grows: whether there will be more; playing waits for it then.
    """

    length_s: float
    time_s: float = 0.0
    is_playing: bool = False
    speed: float = 1.0
    open_s: float = math.inf
    grows: bool = False

    @property
    def end_s(self) -> float:
        """The last moment that can be shown now."""
        return min(self.length_s, self.open_s)

    def advance(self, passed_s: float) -> None:
        """Move on by some seconds of wall time; it stops at the end."""
        if self.is_playing:
            self.seek(self.time_s + passed_s * self.speed)
            self.is_playing = self.grows or self.time_s < self.end_s

    def seek(self, time_s: float) -> None:
        """Go to a moment, at most to the beginning or the end."""
        self.time_s = min(max(time_s, 0.0), self.end_s)

    def play(self) -> None:
        """Play; at the end, from the beginning."""
        if self.time_s >= self.end_s and not self.grows:
            self.time_s = 0.0
        self.is_playing = self.grows or self.end_s > 0.0

    def pause(self) -> None:
        """Stay at this moment."""
        self.is_playing = False

    def set_speed(self, speed: float) -> None:
        """Change the speed, within its limits."""
        self.speed = min(max(speed, MIN_SPEED), MAX_SPEED)
