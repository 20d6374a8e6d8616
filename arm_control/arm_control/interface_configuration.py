"""Which interfaces a controller asks for."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum


class InterfaceKind(Enum):
    """How `InterfaceConfiguration.names` is to be read."""

    NONE = "none"
    ALL = "all"
    INDIVIDUAL = "individual"
    INDIVIDUAL_BEST_EFFORT = "individual_best_effort"
    REGEX = "regex"


@dataclass(frozen=True, slots=True)
class InterfaceConfiguration:
    """The interfaces a controller wants, by full name ('j0/position') or by rule."""

    kind: InterfaceKind
    names: tuple[str, ...] = ()

    @classmethod
    def none(cls) -> "InterfaceConfiguration":
        """Ask for nothing."""
        return cls(InterfaceKind.NONE)

    @classmethod
    def all(cls) -> "InterfaceConfiguration":
        """Ask for everything there is."""
        return cls(InterfaceKind.ALL)

    @classmethod
    def individual(cls, names: Iterable[str]) -> "InterfaceConfiguration":
        """Ask for exactly these, in this order; a missing one prevents activation."""
        return cls(InterfaceKind.INDIVIDUAL, tuple(names))

    @classmethod
    def individual_best_effort(cls, names: Iterable[str]) -> "InterfaceConfiguration":
        """Ask for those of these that exist, in this order."""
        return cls(InterfaceKind.INDIVIDUAL_BEST_EFFORT, tuple(names))

    @classmethod
    def regex(cls, patterns: Iterable[str]) -> "InterfaceConfiguration":
        """Ask for all whose full name matches one of the patterns."""
        return cls(InterfaceKind.REGEX, tuple(patterns))

    @property
    def is_by_name(self) -> bool:
        """Whether it names interfaces, rather than take what there is."""
        return self.kind in (InterfaceKind.INDIVIDUAL, InterfaceKind.INDIVIDUAL_BEST_EFFORT)

    def resolve(self, existing: Sequence[str]) -> tuple[str, ...]:
        """Return the full names asked for; of INDIVIDUAL ones, some may not exist.

        Args:
            existing: every interface there is, in the order of the manager's array.
        """
        match self.kind:
            case InterfaceKind.NONE:
                return ()
            case InterfaceKind.ALL:
                return tuple(existing)
            case InterfaceKind.INDIVIDUAL:
                return self.names
            case InterfaceKind.INDIVIDUAL_BEST_EFFORT:
                there = frozenset(existing)
                return tuple(name for name in self.names if name in there)
            case InterfaceKind.REGEX:
                patterns = [re.compile(pattern) for pattern in self.names]
                return tuple(name for name in existing if any(p.fullmatch(name) for p in patterns))
