"""The parts of a launch description, and what is known of them before it is expanded."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path


class LaunchDescriptionEntity:
    """A part of a launch description, as plans and events refer to it; see `Action`."""

    def describe(self) -> str:
        """Return its name in messages."""
        return f"a {type(self).__name__}"


@dataclass(frozen=True, slots=True)
class ArgumentInfo:
    """A declared launch argument, for listings; it is required if `default` is None."""

    name: str
    default: str | None
    description: str | None
    choices: tuple[str, ...]
    launch_file: Path | None


@dataclass(slots=True)
class LaunchSurvey:
    """What all actions declare and contain, whatever their conditions say."""

    arguments: dict[str, ArgumentInfo] = field(default_factory=dict)
    actions: set[LaunchDescriptionEntity] = field(default_factory=set)
    process_names: set[str] = field(default_factory=set)

    def add_argument(self, argument: ArgumentInfo) -> None:
        """Add an argument. Of two with the same name the outer one is kept."""
        self.arguments.setdefault(argument.name, argument)
