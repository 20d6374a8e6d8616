"""Numbers typed beside sliders, which the page's script sends through the channel."""

from collections.abc import Callable

from arm_viewer.channel import Browser, Handler, Message

KIND = "typed_number"

ROUNDING = 1e-9
"""How far beyond a limit a number may be, in rad or m; it counts as the limit."""

Take = Callable[[str, str], str]
"""Takes a slider's identifier and the text typed beside it; returns the problem, or ""."""


def typed_number_handler(take: Take) -> Handler:
    """Return a handler that answers each typed number.

    `number` of a message identifies it, `slider` the slider, and `text` is the typed text. The
    answer has the same number, and `problem`.
    """

    def handle(message: Message, browser: Browser) -> None:
        number = int(message.number("number"))
        problem = take(message.text("slider"), message.text("text"))
        browser.send(KIND, {"number": number, "problem": problem})

    return handle


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
