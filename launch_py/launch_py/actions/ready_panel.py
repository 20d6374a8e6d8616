"""Tells the user what to do once everything is ready."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launch_py.actions.action import Action
from launch_py.plan import PanelEntry
from launch_py.substitution import Pairs, Text, perform_pairs, perform_text

if TYPE_CHECKING:
    from launch_py.conditions import Condition
    from launch_py.launch_context import LaunchContext


class ReadyPanel(Action):
    """Topics, commands to paste and notes, shown when every process is ready.

    Several panels, for instance of included files, are shown as one; the first title counts.
    The supervisor adds the log folder, the domain id and how to stop.

    Args:
        title: what has been launched.
        topics: pairs of topic and meaning.
        commands: pairs of purpose and command line.
        notes: pairs of heading and text.
        condition: whether it is shown.
    """

    def __init__(
        self,
        *,
        title: Text | None = None,
        topics: Pairs = (),
        commands: Pairs = (),
        notes: Pairs = (),
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.title = title
        self.topics = topics
        self.commands = commands
        self.notes = notes

    def expand(self, context: LaunchContext) -> None:
        """Add it to the plan."""
        title = None if self.title is None else perform_text(context, self.title)
        context.plan.add_panel(
            PanelEntry(
                title=title,
                topics=perform_pairs(context, self.topics, "topics="),
                commands=perform_pairs(context, self.commands, "commands="),
                notes=perform_pairs(context, self.notes, "notes="),
            )
        )
