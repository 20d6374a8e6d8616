"""Which bodies have touched each other, and when."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from arm_gazebo.world.entity import WORLD_FRAME

AWAKE = 1
"""MuJoCo's mjS_AWAKE."""


@dataclass(slots=True)
class Touch:
    """A time during which two bodies touched.

    Attributes:
        bodies: their names; "world" for the world.
        began_s: the first time at which they touched.
        ended_s: the last time at which they touched.
    """

    bodies: tuple[str, str]
    began_s: float
    ended_s: float

    def __str__(self) -> str:
        first, second = self.bodies
        when = f"at {self.began_s:.3f} s"
        if self.ended_s > self.began_s:
            when = f"from {self.began_s:.3f} s to {self.ended_s:.3f} s"
        return f"{first} touches {second} {when}"


class TouchLog:
    """Records which bodies touch after each control period. The simulation's thread.

    Attributes:
        touches: all touches so far, in the order in which they began.
    """

    def __init__(self) -> None:
        self.touches: list[Touch] = []
        self._present: dict[tuple[str, str], Touch] = {}
        self._seen = b""
        self._data: Any = None

    def clear(self) -> None:
        """Forget all touches."""
        self.touches, self._present, self._data = [], {}, None

    @property
    def present(self) -> tuple[Touch, ...]:
        """The touches that still last."""
        return tuple(self._present.values())

    def note(self, time_s: float, data: Any) -> None:
        """Record the touches in MuJoCo's data after a step."""
        contacts = data.contact
        seen = contacts.geom.tobytes() + contacts.efc_address.tobytes() if data.ncon else b""
        if seen != self._seen or data is not self._data:
            self._seen, self._data = seen, data
            pairs = dict.fromkeys(_pairs(data.model, contacts))
            pairs.update(dict.fromkeys(pair for pair in self._present if _sleep(pair, data)))
            self._present = {
                pair: self._present.get(pair) or self._begin(pair, time_s) for pair in pairs
            }
        for touch in self._present.values():
            touch.ended_s = time_s

    def _begin(self, pair: tuple[str, str], time_s: float) -> Touch:
        touch = Touch(pair, time_s, time_s)
        self.touches.append(touch)
        return touch


def _pairs(model: Any, contacts: Any) -> Iterator[tuple[str, str]]:
    """Return the names of the bodies that press on each other."""
    for (first, second), address in zip(contacts.geom, contacts.efc_address, strict=True):
        # A contact without a constraint is a gap that MuJoCo only watches.
        if address >= 0 and first >= 0 and second >= 0:
            bodies = model.geom_bodyid[first], model.geom_bodyid[second]
            one, other = sorted(model.body(int(body)).name or WORLD_FRAME for body in bodies)
            yield one, other


def _sleep(pair: tuple[str, str], data: Any) -> bool:
    """Return whether both bodies sleep: MuJoCo does not look for contacts between them."""
    try:
        return all(data.body_awake[data.model.body(name).id] != AWAKE for name in pair)
    except KeyError:  # One of them was deleted.
        return False
