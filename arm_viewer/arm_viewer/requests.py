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


@dataclass(frozen=True, slots=True)
class SwitchControllers:
    """Activate and deactivate controllers of one manager, all or none.

    Attributes:
        manager: absolute name of its node.
        activate: names of inactive controllers.
        deactivate: names of active controllers.
    """

    manager: str
    activate: tuple[str, ...] = ()
    deactivate: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Configure:
    """Configure a controller that is loaded and no more.

    Attributes:
        manager: absolute name of its manager's node.
        controller: its name.
    """

    manager: str
    controller: str


@dataclass(frozen=True, slots=True)
class MeasureRates:
    """Measure the rates of all topics from now on, or no more."""

    wanted: bool


@dataclass(frozen=True, slots=True)
class ShowPictures:
    """Subscribe to these image topics, and to no others."""

    topics: frozenset[str]


Request = ShowPictures | MoveJoints | SwitchControllers | Configure | MeasureRates
Send = Callable[[Request], None]
"""Hands a request to the ROS thread; never blocks, may be called from any thread."""
