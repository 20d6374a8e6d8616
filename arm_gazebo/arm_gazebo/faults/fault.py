"""Faults as people write them: `joint_stalled j0`, `sensor_noisy j0/position 0.01 7`."""

import math
from enum import Enum

from arm_gazebo.errors import FaultError
from arm_node.frozen import frozen


class FaultKind(Enum):
    """The kinds of faults; each value is the word that users write."""

    JOINT_STALLED = "joint_stalled"
    SENSOR_FROZEN = "sensor_frozen"
    SENSOR_NOISY = "sensor_noisy"
    SENSOR_NAN = "sensor_nan"
    CONTROLLER_RAISES = "controller_raises"
    SLOW_TICK = "slow_tick"


USAGE = {
    FaultKind.JOINT_STALLED: "JOINT",
    FaultKind.SENSOR_FROZEN: "CHANNEL",
    FaultKind.SENSOR_NOISY: "CHANNEL DEVIATION [SEED]",
    FaultKind.SENSOR_NAN: "CHANNEL",
    FaultKind.CONTROLLER_RAISES: "CONTROLLER",
    FaultKind.SLOW_TICK: "SECONDS",
}
"""The words that follow the kind. A channel is a state interface; a joint or a sensor stands for
all of its channels."""


@frozen
class Fault:
    """A fault.

    Attributes:
        kind: what goes wrong.
        target: the joint, channel or controller; "" for the tick.
        amount: standard deviation of the noise in the unit of the reading, or the seconds of wall
            time that each tick takes longer.
        seed: of the noise.
    """

    kind: FaultKind
    target: str = ""
    amount: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        """Raise FaultError if the amount is not a positive number."""
        needs_amount = self.kind in (FaultKind.SENSOR_NOISY, FaultKind.SLOW_TICK)
        if needs_amount and not 0.0 < self.amount < math.inf:
            raise FaultError(f"{self.kind.value} needs a positive number, not {self.amount:g}")
        if self.seed < 0:
            raise FaultError(f"the seed must be at least 0, not {self.seed}")

    def __str__(self) -> str:
        return f"{self.target} {self.kind.value}".strip().replace("_", " ")

    @property
    def text(self) -> str:
        """What `read_fault` reads."""
        words = (self.kind.value, self.target, self.amount, self.seed)
        return " ".join(str(word) for word in words if word)


def read_fault(text: str) -> Fault:
    """Return the fault that a text describes.

    Raises:
        FaultError: it describes none; the message says how to write one.
    """
    words = text.split()
    kind = next((kind for kind in FaultKind if words and kind.value == words[0]), None)
    if kind is None:
        known = ", ".join(kind.value for kind in FaultKind)
        raise FaultError(f"'{text}' is not a fault; the kinds are {known}")
    given, wanted = words[1:], USAGE[kind].split()
    required = [word for word in wanted if not word.startswith("[")]
    if not len(required) <= len(given) <= len(wanted):
        raise FaultError(f"'{text}' is not a fault; write {kind.value} {USAGE[kind]}")
    values = dict(zip((word.strip("[]") for word in wanted), given, strict=False))
    try:
        amount = float(values.get("DEVIATION", values.get("SECONDS", "0")))
        seed = int(values.get("SEED", "0"))
    except ValueError as error:
        raise FaultError(f"'{text}' needs numbers; write {kind.value} {USAGE[kind]}") from error
    return Fault(kind, "" if kind is FaultKind.SLOW_TICK else given[0], amount, seed)
