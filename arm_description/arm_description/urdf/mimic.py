"""Mimic joints, over chains of any length."""

from collections.abc import Container, Mapping
from dataclasses import dataclass

from arm_description.errors import MimicCycleError


@dataclass(frozen=True, slots=True)
class Mimic:
    """Position = multiplier x position of `joint` + offset."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0

    def position(self, leader: float) -> float:
        """Return this joint's position for a position of `joint` (rad or m)."""
        return self.multiplier * leader + self.offset


def resolve_leader(name: str, mimics: Mapping[str, Mimic], known: Container[str] = ()) -> Mimic:
    """Return a joint's position as a function of its leader's position.

    Args:
        name: the joint. A joint that is not a mimic joint is its own leader.
        mimics: the mimic rules by joint name.
        known: joints whose position is known: the nearest of them, including the joint itself, is
            the leader.

    Raises:
        MimicCycleError: the joints mimic each other in a circle.
    """
    chain = [name]
    multiplier, offset = 1.0, 0.0
    while name in mimics and name not in known:
        mimic = mimics[name]
        offset += multiplier * mimic.offset
        multiplier *= mimic.multiplier
        name = mimic.joint
        if name in chain:
            # Same message as ROS 2's joint_state_publisher.
            raise MimicCycleError(f"Found an infinite recursive mimic chain: {[*chain, name]}")
        chain.append(name)
    return Mimic(name, multiplier, offset)
