"""What an expert is: it knows which positions the joints are to be commanded to next."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
AHEAD = 25
"""How many commands ahead of the last known place a way is searched for the present one."""

RESTING = 1e-5
"""Change of a command, in rad or m, that is no motion."""


class Expert(Protocol):
    """Shows an episode of a task. Its answer depends on the state, not on who brought it about."""

    def command(self, last: Array) -> Array:
        """Return the next positions of the commanded joints after the last ones, shape (n,)."""
        ...


class WayExpert:
    """Leads along commands that were planned once, from whichever of them is nearest.

    Another's action may leave the way; the expert then leads back to it.

    Args:
        commands: the way, shape (m, n); neighbours are as far apart as one action reaches.
    """

    def __init__(self, commands: Sequence[Array] | Array) -> None:
        way = np.asarray(commands, dtype=np.float64)
        # Where the way rests, the nearest command would be the same one for ever.
        moved = np.abs(np.diff(way, axis=0)).max(axis=1, initial=0.0) > RESTING
        self._commands = way[np.append(True, moved)]
        self._at = 0

    def command(self, last: Array) -> Array:
        """See `Expert`; after the end of the way, its end."""
        near = self._commands[self._at : self._at + AHEAD]
        self._at += int(np.square(near - last).sum(axis=1).argmin())
        return self._commands[min(self._at + 1, len(self._commands) - 1)]
