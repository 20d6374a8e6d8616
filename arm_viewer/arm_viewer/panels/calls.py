"""The tab `Calls` of the dock: what can be called, forms, and what becomes of each call.

The tab itself is part of the served page (`front/calls.*`). This panel tells it what can be called,
and brings each browser what has become of its own calls.
"""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from viser import GuiApi

from arm_viewer.calls.call import (
    MAX_RATE_HZ,
    MIN_RATE_HZ,
    Callee,
    CallKind,
    CallState,
    EndCall,
    OpenForm,
    PlaceCall,
)
from arm_viewer.calls.form import FormField
from arm_viewer.channel import Browser, Channel, Message
from arm_viewer.errors import BrowserMessageError
from arm_viewer.requests import Send
from arm_viewer.snapshot import Snapshot

CALLEES, FORM, PLACE, END, CALL = "callees", "call_form", "call_place", "call_end", "call"
"""Kinds of messages: what can be called, the user's wishes, and what has become of a call."""


@dataclass(slots=True)
class _Asked:
    """A call of a browser.

    Attributes:
        browser: who asked.
        number: how the browser knows the call.
        callee: what is called.
        told: what the browser was told last.
    """

    browser: Browser
    number: int
    callee: Callee
    told: CallState | None = None


class Calls:
    """Passes calls of the browsers on, and what becomes of them back."""

    def __init__(self, channel: Channel, send: Send) -> None:
        """Use the page's channel; send requests with `send`."""
        self._channel = channel
        self._send = send
        self._callees: Mapping[tuple[str, str], Callee] = {}
        self._listed: tuple[Callee, ...] | None = None
        self._asked: dict[int, _Asked] = {}
        self._numbers = itertools.count(1)

    def build(self, gui: GuiApi) -> None:
        """Serve the browsers' messages."""
        self._channel.on(FORM, self._take_form)
        self._channel.on(PLACE, self._take_call)
        self._channel.on(END, self._take_end)

    def update(self, snapshot: Snapshot) -> None:
        """Send what is new."""
        if snapshot.callees != self._listed:
            self._listed = snapshot.callees
            self._callees = {(c.kind.value, c.name): c for c in snapshot.callees}
            listed = [[c.kind.value, c.name, c.type] for c in snapshot.callees]
            self._channel.send(CALLEES, {"callees": listed}, keep=True)
        for number, asked in tuple(self._asked.items()):
            state = snapshot.calls.get(number)
            if not asked.browser.is_connected:
                self._leave(number, asked)
            elif state is not None and state is not asked.told:
                asked.told = state
                asked.browser.send(CALL, {"number": asked.number, **_fields(state)})
                if state.is_over:
                    del self._asked[number]

    def _leave(self, number: int, asked: _Asked) -> None:
        """End what nobody watches any more; a goal goes on, as its robot is under way."""
        del self._asked[number]
        if asked.callee.kind is not CallKind.ACTION:
            self._send(EndCall(number))

    def _take_form(self, message: Message, browser: Browser) -> None:
        self._send(OpenForm(*self._ask(message, browser)))

    def _take_call(self, message: Message, browser: Browser) -> None:
        typed, rate_hz = message.named_texts("typed"), message.number("rate_hz")
        if rate_hz and not MIN_RATE_HZ <= rate_hz <= MAX_RATE_HZ:
            raise BrowserMessageError(
                f"a rate goes from {MIN_RATE_HZ:g} to {MAX_RATE_HZ:g} Hz, not {rate_hz:g}"
            )
        self._send(PlaceCall(*self._ask(message, browser), typed, rate_hz))

    def _take_end(self, message: Message, browser: Browser) -> None:
        wanted = int(message.number("number"))
        for number, asked in self._asked.items():
            if asked.browser is browser and asked.number == wanted:
                self._send(EndCall(number))

    def _ask(self, message: Message, browser: Browser) -> tuple[int, Callee]:
        """Keep a browser's new call; return its number and what is called."""
        kind, name = message.text("of"), message.text("name")
        callee = self._callees.get((kind, name))
        if callee is None:
            raise BrowserMessageError(f"there is no {kind} {name} any more")
        number = next(self._numbers)
        self._asked[number] = _Asked(browser, int(message.number("number")), callee)
        return number, callee


def _fields(state: CallState) -> dict[str, Any]:
    return {
        "text": state.text,
        "answer": state.answer,
        "over": state.is_over,
        "failed": state.is_failed,
        "form": None if state.form is None else list(map(_field, state.form)),
    }


def _field(field: FormField) -> dict[str, Any]:
    return {
        "path": field.path,
        "type": field.type,
        "kind": field.kind.value,
        "text": field.text,
        # As text: a browser would round whole numbers of 64 bits.
        "least": None if field.least is None else f"{field.least:.12g}",
        "most": None if field.most is None else f"{field.most:.12g}",
        "about": field.about,
        "fixed": field.is_fixed,
    }
