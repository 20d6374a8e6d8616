"""What every part of the page has."""

from typing import Protocol

from viser import GuiApi

from arm_viewer.snapshot import Snapshot


class Panel(Protocol):
    """A part of the page, used in viser's event loop alone.

    Callbacks of its elements run in viser's threads: they do nothing but send a request, or note
    a plain value that the next `update` looks at.
    """

    def build(self, gui: GuiApi) -> None:
        """Make the elements, inside the container that is open; called once."""
        ...

    def update(self, snapshot: Snapshot) -> None:
        """Show what is new; called 30 times a second, so what has not changed is not sent."""
        ...
