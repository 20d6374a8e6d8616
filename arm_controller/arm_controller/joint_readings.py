"""The last known state of each joint, by name, whatever order the messages have."""

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class JointReading:
    """Position (rad or m), velocity and effort (N m or N) of a joint; None where not told."""

    position: float
    velocity: float | None
    effort: float | None

    def __str__(self) -> str:
        return (
            f"Position: {self.position:.6f} Velocity: {_figure(self.velocity)} "
            f"Effort: {_figure(self.effort)}"
        )


class JointReadings:
    """Collects joint states from any number of sources; the last word on a joint counts."""

    def __init__(self) -> None:
        self._readings: dict[str, JointReading] = {}

    def update(
        self,
        names: Sequence[str],
        positions: Sequence[float],
        velocities: Sequence[float] = (),
        efforts: Sequence[float] = (),
    ) -> bool:
        """Take in one message; return whether it could be used.

        A message whose names and positions differ in number says nothing reliable and is left
        out; velocities and efforts that do not match count as not told.
        """
        if len(names) != len(positions):
            return False
        with_velocity = len(velocities) == len(names)
        with_effort = len(efforts) == len(names)
        for index, name in enumerate(names):
            self._readings[name] = JointReading(
                positions[index],
                velocities[index] if with_velocity else None,
                efforts[index] if with_effort else None,
            )
        return True

    @property
    def names(self) -> tuple[str, ...]:
        """The joints heard of so far."""
        return tuple(self._readings)

    @property
    def positions(self) -> dict[str, float]:
        """Position (rad or m) by joint name; a copy."""
        return {name: reading.position for name, reading in self._readings.items()}

    def get(self, name: str) -> JointReading | None:
        """Return the last reading of a joint, or None if there was none."""
        return self._readings.get(name)


def _figure(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.6f}"
