"""Position commands one after the other, made into a target that moves."""

LONGEST_INTERVAL_S = 0.05
"""Commands further apart are steps; closer ones are samples of one motion."""


class CommandStream:
    """Turns the commands of a joint into a target with a velocity.

    A single command is a step: the target jumps and stands. Commands that follow each other
    within 50 ms are samples of a motion: the target runs from one to the next in the time that
    lay between them, so a trajectory is followed without stopping at every sample.

    Attributes:
        target: where the target is at the end of this control period.
        velocity: how fast it moves.
    """

    __slots__ = ("_command", "_last_change", "_left", "_period_s", "target", "velocity")

    def __init__(self, position: float, period_s: float) -> None:
        self.target = position
        self.velocity = 0.0
        self._period_s = period_s
        self._command = position
        self._left = 0
        self._last_change = -1_000_000

    def command(self, position: float, tick: int) -> None:
        """Take a command, of the control period with this number."""
        if position == self._command:
            return
        interval = tick - self._last_change
        self._command = position
        self._last_change = tick
        if interval * self._period_s > LONGEST_INTERVAL_S:
            self._left = 0
            self.target = position
            self.velocity = 0.0
        else:
            self._left = max(interval, 1)
            self.velocity = (position - self.target) / (self._left * self._period_s)

    def advance(self) -> None:
        """Move on by one control period; called once in each, after its commands."""
        if self._left > 1:
            self._left -= 1
            self.target += self.velocity * self._period_s
        elif self._left == 1:
            self._left = 0
            self.target = self._command
        else:
            self.velocity = 0.0
