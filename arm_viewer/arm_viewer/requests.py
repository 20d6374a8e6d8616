"""What the page asks of the ROS thread: frozen data, put into a queue by any thread."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class MoveJoints:
    """Command joints of a robot, by whatever controllers are active on them.

    Attributes:
        namespace: the robot's, as `Description.namespace`.
        positions: in rad or m, by joint.
    """

    namespace: str
    positions: dict[str, float]


Request = MoveJoints
Send = Callable[[Request], None]
"""Hands a request to the ROS thread; never blocks, may be called from any thread."""
