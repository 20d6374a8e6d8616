"""What the node decides: pure Python, tested without ROS."""

import math
from collections.abc import Sequence
from itertools import cycle

POSES = ((1.0, 0.5, 0.1, 0.5), (-1.0, 0.2, 0.1, 0.5))
"""Joint positions in rad."""
TOLERANCE_RAD = 0.02
"""Distance at which a joint has reached its position, and least progress towards it."""
STUCK_AFTER_S = 3.0
"""Time without progress after which the arm counts as stuck."""


class Patrol:
    """Decides where the arm goes next.

    Attributes:
        visited: how many poses it has reached.
        is_stuck: whether it makes no progress.
    """

    def __init__(self, poses: Sequence[Sequence[float]] = POSES) -> None:
        self.visited = 0
        self.is_stuck = False
        self._poses = cycle(tuple(pose) for pose in poses)
        self._pose = next(self._poses)
        self._least = math.inf
        self._progress_s: float | None = None

    def command(self, time_s: float, positions: Sequence[float]) -> tuple[float, ...] | None:
        """Return the command for a state, or None to send nothing.

        It is repeated with each state, so a lost message costs nothing.

        Args:
            time_s: time of the state.
            positions: of the joints, in rad.
        """
        if not all(map(math.isfinite, positions)):
            return None
        pairs = zip(positions, self._pose, strict=True)
        distance = max(abs(position - goal) for position, goal in pairs)
        if distance < TOLERANCE_RAD:
            self.visited += 1
            self._pose = next(self._poses)
            self._least, self._progress_s = math.inf, time_s
            return self._pose
        if self._progress_s is None or distance < self._least - TOLERANCE_RAD:
            self._least, self._progress_s = distance, time_s
        self.is_stuck = time_s - self._progress_s > STUCK_AFTER_S
        return self._pose
