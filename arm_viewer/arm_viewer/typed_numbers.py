"""The WebSocket through which the page's script sends numbers typed beside sliders."""

import json
from collections.abc import Callable
from typing import Any

from websockets.asyncio.server import ServerConnection

PATH = "/typed_numbers"
MAX_LENGTH = 100
"""Longest text of a number; a longer one is a programming error."""

ROUNDING = 1e-9
"""How far beyond a limit a number may be, in rad or m; it counts as the limit."""

Take = Callable[[str, str], str]
"""Takes a slider's identifier and the text typed beside it; returns the problem, or ""."""


async def serve_typed_numbers(connection: ServerConnection, take: Take) -> None:
    """Answer each message of a page until the page disconnects.

    A message is a JSON object: `number` identifies the message, `slider` the slider, and `text` is
    the typed text. The answer has the same number, and `problem`.
    """
    async for message in connection:
        number, slider, text = _read(message)
        if slider is None or text is None or len(text) > MAX_LENGTH:
            problem = "the page's script did not send a number"
        else:
            problem = take(slider, text)
        await connection.send(json.dumps({"number": number, "problem": problem}))


def number_typed(text: str, name: str, lower: float, upper: float) -> float:
    """Return the number in a text.

    Raises:
        ValueError: the text is not a number, or the number is not between `lower` and `upper`;
            the message is a sentence.
    """
    try:
        number = float(text)
    except ValueError:
        raise ValueError(f"'{text}' is not a number; write it like -0.5 or 1e-2") from None
    # Also rejects NaN.
    if not lower - ROUNDING <= number <= upper + ROUNDING:
        raise ValueError(f"'{name}' goes from {lower:g} to {upper:g}; {number:g} is outside")
    return min(max(number, lower), upper)


def _read(message: str | bytes) -> tuple[int, str | None, str | None]:
    try:
        read: Any = json.loads(message)
        number, slider, text = (read.get(key) for key in ("number", "slider", "text"))
    except (ValueError, AttributeError, RecursionError):
        return 0, None, None
    return (
        number if isinstance(number, int) else 0,
        slider if isinstance(slider, str) else None,
        text if isinstance(text, str) else None,
    )
