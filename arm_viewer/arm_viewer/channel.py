"""The page's own WebSocket: messages by kind between this process and the scripts of the page.

A text frame is a JSON object whose `kind` names its handler. A binary frame starts with one byte
that does the same. The channel shares origin, port and request gate with the page.
"""

import base64
import json
import logging
import math
from collections.abc import Callable, Mapping
from typing import Any

from websockets.asyncio.server import ServerConnection, broadcast
from websockets.protocol import State

from arm_viewer.errors import BrowserMessageError

PATH = "/channel"
MAX_LENGTH = 65536
"""Longest frame that a browser may send, in characters or bytes."""
MAX_TEXT_LENGTH = 200
"""Longest text in a field of a message."""
MAX_TEXTS = 200
"""Longest list of texts in a field of a message."""
MAX_UNSENT_BYTES = 262144
"""A browser that is this far behind misses binary frames until it has caught up."""
REFUSED = "refused"
"""The kind of the answer to a message that cannot be served."""
READ_ONLY = "this page is read-only: nothing was sent"

logger = logging.getLogger(__name__)


class Message:
    """A message from a browser; each accessor checks its field.

    Attributes:
        kind: what the message is about.
    """

    def __init__(self, kind: str, fields: Mapping[str, object]) -> None:
        self.kind = kind
        self._fields = fields

    def text(self, name: str) -> str:
        """Return a text.

        Raises:
            BrowserMessageError: the field is missing, not a text, or too long.
        """
        value = self._fields.get(name)
        if not isinstance(value, str) or len(value) > MAX_TEXT_LENGTH:
            raise BrowserMessageError(
                f"'{name}' of '{self.kind}' is not a text of at most {MAX_TEXT_LENGTH} characters"
            )
        return value

    def texts(self, name: str) -> tuple[str, ...]:
        """Return a list of texts.

        Raises:
            BrowserMessageError: the field is not a list of at most MAX_TEXTS texts.
        """
        values = self._fields.get(name)
        if not isinstance(values, list) or len(values) > MAX_TEXTS:
            raise BrowserMessageError(
                f"'{name}' of '{self.kind}' is not a list of at most {MAX_TEXTS} texts"
            )
        return tuple(Message(self.kind, {name: value}).text(name) for value in values)

    def number(self, name: str) -> float:
        """Return a finite number.

        Raises:
            BrowserMessageError: the field is missing or not a finite number.
        """
        value = self._fields.get(name)
        try:
            number = math.nan if isinstance(value, bool) else float(value)  # pyright: ignore[reportArgumentType]
        except (TypeError, ValueError, OverflowError):
            number = math.nan
        if isinstance(value, str) or not math.isfinite(number):
            raise BrowserMessageError(f"'{name}' of '{self.kind}' is not a finite number")
        return number

    def flag(self, name: str) -> bool:
        """Return true or false.

        Raises:
            BrowserMessageError: the field is missing or neither.
        """
        value = self._fields.get(name)
        if not isinstance(value, bool):
            raise BrowserMessageError(f"'{name}' of '{self.kind}' is neither true nor false")
        return value

    def data(self, name: str) -> bytes:
        """Return bytes that were sent in base 64; only the frame's length limits them.

        Raises:
            BrowserMessageError: the field is missing, or has something else.
        """
        value = self._fields.get(name)
        try:
            return base64.b64decode(value if isinstance(value, str) else "?", validate=True)
        except ValueError:
            raise BrowserMessageError(f"'{name}' of '{self.kind}' is not base 64") from None

    def named_texts(self, name: str) -> dict[str, str]:
        """Return texts by name; only the frame's length limits them.

        Raises:
            BrowserMessageError: the field is missing, or has something else.
        """
        value = self._fields.get(name)
        if not isinstance(value, dict) or not all(isinstance(v, str) for v in value.values()):
            raise BrowserMessageError(f"'{name}' of '{self.kind}' does not have texts by name")
        return {str(key): text for key, text in value.items()}


class Browser:
    """The page in one browser, as long as it is connected."""

    def __init__(self, connection: ServerConnection) -> None:
        self._connection = connection

    @property
    def is_connected(self) -> bool:
        """Whether it can still be sent to."""
        return self._connection.state is State.OPEN

    def send(self, kind: str, fields: Mapping[str, object]) -> None:
        """Send a message to this browser; nothing happens if it has left."""
        broadcast((self._connection,), _encoded(kind, fields))

    def send_bytes(self, kind: int, payload: bytes) -> bool:
        """Send a binary frame to this browser; return False if it has not nearly caught up."""
        if _unsent_bytes(self._connection) >= MAX_UNSENT_BYTES:
            return False
        broadcast((self._connection,), bytes((kind,)) + payload)
        return True


Handler = Callable[[Message, Browser], None]
"""Serves a message in viser's event loop; a BrowserMessageError's sentence goes to the browser."""


class Channel:
    """Connects the scripts of all browsers with their handlers; use it in viser's event loop."""

    def __init__(self) -> None:
        self._handlers: dict[str, Handler] = {}
        self._harmless: set[str] = set()
        self._connections: set[ServerConnection] = set()
        self._kept: dict[str, str] = {}

    def on(self, kind: str, handler: Handler, *, changes: bool = True) -> None:
        """Let a handler serve the messages of a kind; it replaces an earlier one.

        Args:
            kind: what the messages are about.
            handler: serves them.
            changes: whether they change more than what their own browser shows. A browser that
                may only look is refused these.
        """
        self._handlers[kind] = handler
        (self._harmless.discard if changes else self._harmless.add)(kind)

    def send(self, kind: str, fields: Mapping[str, object], *, keep: bool = False) -> None:
        """Send a message to every browser.

        Args:
            kind: names the handler in the browser.
            fields: its content, plain values that JSON has; numbers are finite.
            keep: send it also to each browser that connects later, until the next message of this
                kind replaces it.
        """
        text = _encoded(kind, fields)
        if keep:
            self._kept[kind] = text
        broadcast(self._connections, text)

    def send_bytes(self, kind: int, payload: bytes) -> None:
        """Send a binary frame of a kind, 0 to 255, to every browser; those that lag miss it."""
        ready = [c for c in self._connections if _unsent_bytes(c) < MAX_UNSENT_BYTES]
        if ready:
            broadcast(ready, bytes((kind,)) + payload)

    @property
    def is_used(self) -> bool:
        """Whether a browser is connected."""
        return bool(self._connections)

    async def serve(self, connection: ServerConnection, *, may_change: bool = True) -> None:
        """Serve a browser until it disconnects; unless it `may_change` things, it only looks."""
        browser = Browser(connection)
        # Without waiting in between, so that no message comes before what it replaces.
        for text in self._kept.values():
            broadcast((connection,), text)
        self._connections.add(connection)
        try:
            async for frame in connection:
                self._take(frame, browser, may_change)
        finally:
            self._connections.discard(connection)

    def _take(self, frame: str | bytes, browser: Browser, may_change: bool) -> None:
        """Serve one frame; whatever is wrong with it is answered and not raised."""
        fields: dict[str, Any] = {}
        try:
            fields = _decoded(frame)
            kind = fields["kind"]
            handler = self._handlers.get(kind)
            if handler is None:
                raise BrowserMessageError(f"the page does not serve '{kind[:MAX_TEXT_LENGTH]}'")
            if not may_change and kind not in self._harmless:
                raise BrowserMessageError(READ_ONLY)
            handler(Message(kind, fields), browser)
        except BrowserMessageError as error:
            _refuse(browser, fields, str(error))
        except Exception:
            # The message's top-level handler: one that fails must not end the browser's connection.
            logger.exception("a message of a browser failed")
            _refuse(browser, fields, "the page failed at this; its log says why")


def _refuse(browser: Browser, fields: Mapping[str, Any], problem: str) -> None:
    number = fields.get("number")
    browser.send(
        REFUSED,
        {
            "of": str(fields.get("kind", ""))[:MAX_TEXT_LENGTH],
            "number": number if isinstance(number, int) else None,
            "problem": problem,
        },
    )


def _decoded(frame: str | bytes) -> dict[str, Any]:
    if len(frame) > MAX_LENGTH:
        raise BrowserMessageError(
            f"the message has {len(frame)} characters; at most {MAX_LENGTH} may be"
        )
    try:
        fields = json.loads(frame)
    except (ValueError, RecursionError):
        raise BrowserMessageError("the message is not JSON") from None
    if not isinstance(fields, dict) or not isinstance(fields.get("kind"), str):
        raise BrowserMessageError("the message is not a JSON object with a 'kind'")
    return fields


def _encoded(kind: str, fields: Mapping[str, object]) -> str:
    return json.dumps({"kind": kind, **fields}, allow_nan=False)


def _unsent_bytes(connection: ServerConnection) -> int:
    return connection.transport.get_write_buffer_size()
