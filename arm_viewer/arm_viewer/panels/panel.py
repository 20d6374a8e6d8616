"""The interface of every panel of the page."""

from collections.abc import Callable, Coroutine, Iterable
from html import escape
from typing import Any, Protocol

from viser import GuiApi, GuiHtmlHandle

from arm_viewer.snapshot import Snapshot

PROBLEM_COLOUR = "#c92a2a"


def note(text: str, colour: str = "inherit") -> str:
    """Return a sentence as HTML; each line becomes a paragraph."""
    lines = "".join(f"<div>{escape(line)}</div>" for line in text.splitlines())
    return (
        f'<div style="color:{colour};font-size:0.8rem;line-height:1.35;padding:0.25em 0.75em;'
        f'overflow-wrap:anywhere">{lines}</div>'
    )


def distinct(options: Iterable[str]) -> tuple[str, ...]:
    """Return each option of a list to choose from once: doubled, it takes the whole page down."""
    return tuple(dict.fromkeys(options))


def in_order(serve: Callable[[Any], object]) -> Callable[[Any], Coroutine[Any, Any, None]]:
    """Return a callback that serves each event at once, in the order in which the user made them.

    viser calls what is not a coroutine function in a pool of threads, late and in any order.
    """

    async def called(event: Any) -> None:
        serve(event)

    return called


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


def fill(element: GuiHtmlHandle, html: str) -> None:
    """Show this in an element; the element is hidden while there is nothing to show."""
    if html and element.content != html:
        element.content = html
    show(element, bool(html))


def say(element: GuiHtmlHandle, sentence: str, colour: str = PROBLEM_COLOUR) -> None:
    """Show a sentence in an element; the element is hidden while there is none."""
    fill(element, sentence and note(sentence, colour))


class Panel(Protocol):
    """A panel of the page; used only in viser's event loop.

    So are the callbacks of its elements, which `in_order` makes of functions. One that takes long
    runs in a thread of viser, and puts its result into a queue for `update`.
    """

    def build(self, gui: GuiApi) -> None:
        """Create the elements inside the open container; called once."""
        ...

    def update(self, snapshot: Snapshot) -> None:
        """Show the snapshot. Called 30 times a second, so it must send only what has changed."""
        ...
