"""What a client asks of a controller switch, and what it is told."""

from dataclasses import dataclass
from enum import IntEnum


class Strictness(IntEnum):
    """What to do with a request that cannot be met in full; numbered as in SwitchController."""

    BEST_EFFORT = 1
    """Drop the names that cannot be switched, do the rest."""
    STRICT = 2
    """All or nothing."""
    AUTO = 3
    """Like BEST_EFFORT, as in ros2_control Jazzy."""
    FORCE_AUTO = 4
    """Like BEST_EFFORT, as in ros2_control Jazzy."""


@dataclass(frozen=True, slots=True)
class SwitchRequest:
    """Controllers to activate and to deactivate in one go; a name in both lists is restarted."""

    activate: tuple[str, ...] = ()
    deactivate: tuple[str, ...] = ()
    strictness: Strictness = Strictness.BEST_EFFORT

    @property
    def is_strict(self) -> bool:
        """Whether it is all or nothing."""
        return self.strictness is Strictness.STRICT


@dataclass(frozen=True, slots=True)
class SwitchResult:
    """Whether a switch succeeded, with the message that clients of ros2_control know."""

    ok: bool
    message: str
