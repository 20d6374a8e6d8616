"""The last known state of each joint, and a check for a silent topic."""

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class LastJointState:
    """Position (rad or m), velocity, and effort (N m or N) of a joint; None if unknown."""

    position: float
    velocity: float | None
    effort: float | None

    def figures(self) -> dict[str, str]:
        """Return the three values by name as text, for a line of print."""
        return {
            "position": _figure(self.position),
            "velocity": _figure(self.velocity),
            "effort": _figure(self.effort),
        }


class JointReadings:
    """Collects joint states from any number of sources; the latest state of a joint is kept."""

    def __init__(self) -> None:
        self._readings: dict[str, LastJointState] = {}

    def update(
        self,
        names: Sequence[str],
        positions: Sequence[float],
        velocities: Sequence[float] = (),
        efforts: Sequence[float] = (),
    ) -> bool:
        """Process one message; return whether it could be used.

        A message with different numbers of names and positions is ignored; velocities or efforts of
        another length count as missing.
        """
        if len(names) != len(positions):
            return False
        with_velocity = len(velocities) == len(names)
        with_effort = len(efforts) == len(names)
        for index, name in enumerate(names):
            self._readings[name] = LastJointState(
                positions[index],
                velocities[index] if with_velocity else None,
                efforts[index] if with_effort else None,
            )
        return True

    @property
    def names(self) -> tuple[str, ...]:
        """The joints of all messages so far."""
        return tuple(self._readings)

    @property
    def positions(self) -> dict[str, float]:
        """Position (rad or m) by joint name; a copy."""
        return {name: reading.position for name, reading in self._readings.items()}

    def get(self, name: str) -> LastJointState | None:
        """Return the last reading of a joint, or None if there was none."""
        return self._readings.get(name)


def _figure(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.6f}"


PATIENCE_S = 5.0


class SilenceWatch:
    """Detects that a topic is silent. Times are from any steady clock (s).

    Args:
        now_s: the current time, from which on the first message is expected.
    """

    def __init__(self, now_s: float) -> None:
        self._since_s = now_s
        self._noticed = False

    def hear(self, now_s: float) -> None:
        """Record that a message has arrived."""
        self._since_s = now_s
        self._noticed = False

    def notices(self, now_s: float) -> bool:
        """Return True once in each silence, as soon as it is too long."""
        if self._noticed or now_s - self._since_s < PATIENCE_S:
            return False
        self._noticed = True
        return True
