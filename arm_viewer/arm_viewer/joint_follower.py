"""What a joint's slider shows: where the user put it, until the joint has come to rest."""

import math

STILL_S = 0.5
LONGEST_HOLD_S = 5.0


class JointFollower:
    """Decides whether a slider follows its joint. One thread at a time.

    While the user drags, and until the joint has stopped, the slider stays where the user put it:
    else it would jump back to where the joint still is. After that it shows where the joint is,
    whoever moves it. A joint that somebody else keeps moving does not hold it for ever.
    """

    def __init__(self, resolution: float) -> None:
        """Take a movement by less than `resolution` (rad or m) for none."""
        self._resolution = resolution
        self._held_from_s = -math.inf
        self._moved_s = -math.inf
        self._position = math.nan

    def hold(self, now_s: float) -> None:
        """Take notice that the user has moved the slider."""
        self._held_from_s = now_s

    def shown(self, position: float, now_s: float) -> float | None:
        """Return what the slider should show, None where it is left as it is.

        Args:
            position: where the joint is, rad or m.
            now_s: on the same clock as `hold`.
        """
        if not math.isfinite(position):
            return None
        if not abs(position - self._position) < self._resolution:
            self._position = position
            self._moved_s = now_s
        return None if self.is_held(now_s) else self._position

    def is_held(self, now_s: float) -> bool:
        """Return whether the slider stays where the user put it."""
        still_s = now_s - max(self._moved_s, self._held_from_s)
        return now_s - self._held_from_s < LONGEST_HOLD_S and still_s < STILL_S
