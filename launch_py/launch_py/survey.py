"""What can be known of a launch description without expanding it: arguments, actions, names."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from launch_py.actions.action import Action


@dataclass(frozen=True, slots=True)
class ArgumentInfo:
    """A declared launch argument as it is listed: `default` None means that it is required."""

    name: str
    default: str | None
    description: str | None
    choices: tuple[str, ...]
    launch_file: Path | None


@dataclass(slots=True)
class Survey:
    """Collects what a walk over all actions finds, whatever their conditions say."""

    arguments: dict[str, ArgumentInfo] = field(default_factory=dict)
    actions: set[Action] = field(default_factory=set)
    process_names: set[str] = field(default_factory=set)

    def add_argument(self, argument: ArgumentInfo) -> None:
        """Note an argument; of two with one name the outer one is what the user sees."""
        self.arguments.setdefault(argument.name, argument)
