"""Counts the pictures of a camera, or the readings of a sensor, that were due and that came."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
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
