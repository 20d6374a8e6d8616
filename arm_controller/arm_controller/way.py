"""Ways of an arm: timed positions of its joints, from rest to rest."""

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class WayPoint:
    """Where the joints are at a time, and how fast they are; rad or m, and per second.

    Attributes:
        time_s: counted from the start of the way.
        positions: shape (n,).
        velocities: shape (n,); without any the joints go on at an even pace.
    """

    time_s: float
    positions: tuple[float, ...]
    velocities: tuple[float, ...]


Way = tuple[WayPoint, ...]
"""Without its start: an arm starts from where it is."""


def way_to(positions: Sequence[float], duration_s: float) -> Way:
    """Return the way of the joints to positions, each at its own pace."""
    return (WayPoint(duration_s, tuple(positions), (0.0,) * len(positions)),)


def reverse_way(way: Way, start: Sequence[float]) -> Way:
    """Return the way back to where a way started."""
    duration_s = way[-1].time_s
    back = [
        WayPoint(duration_s - point.time_s, point.positions, tuple(-v for v in point.velocities))
        for point in reversed(way[:-1])
    ]
    return (*back, *way_to(start, duration_s))
