"""Actions that print messages for the user."""

from __future__ import annotations

from launch_py.action import Action
from launch_py.conditions import Condition
from launch_py.launch_context import LaunchContext
from launch_py.plan.steps import MessageStep, PanelEntry
from launch_py.substitution import Pairs, Text, perform_pairs, perform_text


class LogInfo(Action):
    """Prints a message when the launch begins, or in an event handler when the event happens."""

    def __init__(self, *, msg: Text, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.msg = msg

    def expand(self, context: LaunchContext) -> None:
        """Add the message to the plan."""
        context.plan.add(
            MessageStep(
                after=context.after, delay_s=context.delay_s, text=perform_text(context, self.msg)
            )
        )


class ReadyPanel(Action):
    """Topics, commands to paste and notes, shown when every process is ready.

    Several panels, for example of included files, are merged under the first title. The supervisor
    adds the log folder, the domain id and how to stop.

    Args:
        title: the name of the system that was launched.
        topics: pairs of topic and meaning.
        commands: pairs of purpose and command line.
        notes: pairs of heading and text.
        condition: whether to show the panel.
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
        """Add the panel to the plan."""
        title = None if self.title is None else perform_text(context, self.title)
        context.plan.add_panel(
            PanelEntry(
                title=title,
                topics=perform_pairs(context, self.topics, "topics="),
                commands=perform_pairs(context, self.commands, "commands="),
                notes=perform_pairs(context, self.notes, "notes="),
            )
        )
