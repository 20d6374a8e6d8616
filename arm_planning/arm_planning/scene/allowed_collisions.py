"""Which pairs of links and objects may touch: MoveIt's allowed collision matrix."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from arm_planning.robot.srdf import Srdf


@dataclass(frozen=True, slots=True)
class AllowedCollisions:
    """Pairs that may touch.

    Attributes:
        pairs: whether a pair may touch; the two names of a key in sorted order.
        defaults: whether a name may touch everything that it has no pair with.
    """

    pairs: Mapping[tuple[str, str], bool] = field(default_factory=dict)
    defaults: Mapping[str, bool] = field(default_factory=dict)

    def may_touch(self, first: str, second: str) -> bool:
        """Return whether two may touch: by their pair, else by both defaults, else by the one.

        A pair without an entry and without a default may not.
        """
        pair = (first, second) if first <= second else (second, first)
        if pair in self.pairs:
            return self.pairs[pair]
        known = [self.defaults[name] for name in pair if name in self.defaults]
        return bool(known) and all(known)


def allowed_collisions(srdf: Srdf) -> AllowedCollisions:
    """Return which links may touch by an SRDF.

    Links that may touch everything come first, then the pairs that are checked all the same, then
    the pairs that may touch, as in MoveIt.
    """
    return AllowedCollisions(
        pairs={pair: False for pair in srdf.enabled} | {pair: True for pair in srdf.disabled},
        defaults={link: True for link in srdf.touching},
    )
