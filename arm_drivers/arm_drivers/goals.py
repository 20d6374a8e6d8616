"""What an arm is told: commands, limited in position and speed, or to hold."""

import threading
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from arm_control.loop.clock import Throttle

MAX_STEP_S = 0.1
"""After a longer pause a goal moves no further than in this time."""
RESTS_AFTER_S = 1.0
TOLERANCE_RAD = 1e-6
REMINDER_INTERVAL_S = 5.0


class GoalTracker:
    """Follows commands at a limited speed within the arm's limits. Any thread.

    It starts from the measured positions, so the first goal is never a jump.

    Attributes:
        now_s: the time.
    """

    def __init__(
        self,
        names: Sequence[str],
        lower: NDArray[np.float64],
        upper: NDArray[np.float64],
        max_velocity: float,
        now_s: Callable[[], float],
    ) -> None:
        """Hold nothing yet.

        Args:
            names: of the joints, for messages.
            lower: lowest goals, shape (n,), in rad.
            upper: highest goals, shape (n,).
            max_velocity: how fast a goal may move, in rad/s.
            now_s: the time.
        """
        self._names = names
        self._lower = lower
        self._upper = upper
        self._max_velocity = max_velocity
        self.now_s = now_s
        self._lock = threading.Lock()
        self._stopped = False
        self._commands = self._goals = np.full(len(names), np.nan)
        self._last_s = self._moved_s = now_s()
        self._remarks: dict[str, str] = {}
        self._reminder = Throttle(REMINDER_INTERVAL_S)

    @property
    def rests(self) -> bool:
        """Whether the goals have stood still for a while."""
        return self._last_s - self._moved_s >= RESTS_AFTER_S

    def command(self, commands: NDArray[np.float64]) -> None:
        """Follow these commands, shape (n,); one that is NaN keeps its joint where it is."""
        with self._lock:
            if not self._stopped:
                self._commands = commands

    def hold(self, positions: NDArray[np.float64]) -> None:
        """Hold these positions until the next commands."""
        with self._lock:
            self._commands = self._goals = positions.copy()
            self._last_s = self._moved_s = self.now_s()

    def set_stopped(self, stopped: bool, positions: NDArray[np.float64]) -> None:
        """Hold these positions whatever the commands are; or obey commands again."""
        self.hold(positions)
        with self._lock:
            self._stopped = stopped

    def advance(self) -> NDArray[np.float64]:
        """Return the goals for now, shape (n,)."""
        with self._lock:
            now_s = self.now_s()
            reach = self._max_velocity * min(now_s - self._last_s, MAX_STEP_S)
            wanted = np.where(np.isfinite(self._commands), self._commands, self._goals)
            within = np.clip(wanted, self._lower, self._upper)
            self._note_outside(wanted, within)
            step = np.clip(within - self._goals, -reach, reach)
            if np.abs(step).max() > TOLERANCE_RAD:
                self._moved_s = now_s
            self._goals = self._goals + step
            self._last_s = now_s
            return self._goals

    def remarks(self) -> list[str]:
        """Return what is to be said about commands outside the limits, each now and then."""
        if not self._remarks or not self._reminder.permits():
            return []
        said, self._remarks = list(self._remarks.values()), {}
        return said

    def _note_outside(self, wanted: NDArray[np.float64], within: NDArray[np.float64]) -> None:
        for place in np.flatnonzero(np.abs(wanted - within) > TOLERANCE_RAD).tolist():
            name = self._names[place]
            self._remarks[name] = (
                f"{name} is told {wanted[place]:.3f} rad; the arm's own limits are "
                f"{self._lower[place]:.3f} to {self._upper[place]:.3f} rad, and it stops there"
            )
