"""When the messages of a bag are due while it is played."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PlaySchedule:
    """Relates the bag's time to the player's clock.

    Attributes:
        bag_start_ns: time in the bag at which the playing begins.
        started_s: the player's clock at that moment.
        rate: seconds of the bag in a second of the clock.
    """

    bag_start_ns: int
    started_s: float
    rate: float

    def due_s(self, bag_time_ns: int) -> float:
        """Return the clock's time at which a message of the bag is due."""
        return self.started_s + (bag_time_ns - self.bag_start_ns) * 1e-9 / self.rate

    def bag_time_ns(self, now_s: float) -> int:
        """Return the bag's time at a time of the clock."""
        return self.bag_start_ns + round((now_s - self.started_s) * self.rate * 1e9)
