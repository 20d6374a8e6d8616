"""The interface of every panel of the page."""

from html import escape
from typing import Protocol

from viser import GuiApi

from arm_viewer.snapshot import Snapshot

PROBLEM_COLOUR = "#c92a2a"


def note(text: str, colour: str = "inherit") -> str:
    """Return a sentence as HTML; each line becomes a paragraph."""
    lines = "".join(f"<div>{escape(line)}</div>" for line in text.splitlines())
    return (
        f'<div style="color:{colour};font-size:0.8rem;line-height:1.35;padding:0.25em 0.75em;'
        f'overflow-wrap:anywhere">{lines}</div>'
    )


class Hideable(Protocol):
    """An element of the page, or a node of the scene."""

    @property
    def visible(self) -> bool:
        """Whether it is shown."""
        ...

    @visible.setter
    def visible(self, shown: bool) -> None: ...


def show(element: Hideable, shown: bool) -> None:
    """Show or hide an element; viser's setter takes its time even if nothing changes."""
    if element.visible != shown:
        element.visible = shown


class Panel(Protocol):
    """A panel of the page; used only in viser's event loop.

    Callbacks of its elements run in viser's threads. They only send a request, or store a plain
    value that the next `update` reads.
    """

    def build(self, gui: GuiApi) -> None:
        """Create the elements inside the open container; called once."""
        ...

    def update(self, snapshot: Snapshot) -> None:
        """Show the snapshot. Called 30 times a second, so it must send only what has changed."""
        ...
