"""A connection that loses, delays and repeats messages."""

import math
from dataclasses import dataclass

from arm_sim.errors import CallError


@dataclass(frozen=True, slots=True)
class LinkFault:
    """The faults of a connection.

    Attributes:
        lost: fraction of the messages that are lost.
        doubled: fraction of the others that arrive twice.
        delay_s: how late each message arrives.
        jitter_s: largest random additional delay; messages may overtake others.
        again_s: how long after the first copy the second one arrives.
        seed: seed of the random choices.
    """

    lost: float = 0.0
    doubled: float = 0.0
    delay_s: float = 0.0
    jitter_s: float = 0.0
    again_s: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        """Raise CallError if a value is not a fraction or not a time."""
        for name in ("lost", "doubled"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise CallError(f"the fraction of {name} messages must be from 0 to 1")
        for name in ("delay_s", "jitter_s", "again_s"):
            if not 0.0 <= getattr(self, name) < math.inf:
                raise CallError(f"{name} is a time in seconds, not {getattr(self, name)}")


class FaultyLink:
    """Decides when each message arrives; the same seed gives the same delays."""

    def __init__(self, fault: LinkFault) -> None:
        import numpy as np

        self._fault = fault
        self._random = np.random.default_rng(fault.seed)

    def delays_s(self) -> list[float]:
        """Return the delays of the next message: none if it is lost, two if it is doubled."""
        fault = self._fault
        # Three numbers for each message, so that the fate of one does not affect the others.
        is_lost, is_doubled, late = self._random.random(3).tolist()
        if is_lost < fault.lost:
            return []
        delay_s = fault.delay_s + late * fault.jitter_s
        return [delay_s, delay_s + fault.again_s] if is_doubled < fault.doubled else [delay_s]
