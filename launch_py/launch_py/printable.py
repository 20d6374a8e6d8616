"""Makes the output of processes safe to show on a terminal and to keep in a log file.

A process may write anything: sequences that clear the screen, rename the window or hide text, and
characters that reverse the reading direction. They become visible escapes, as Python writes them.

`arm_node.printable` is the counterpart for names and strings: launch_py imports no arm_* package.
"""

from __future__ import annotations

import re

_UNSAFE = (
    "\x00-\x08\x0b-\x1a\x1c-\x1f\x7f-\x9f"  # control characters but tab, newline and escape
    "\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"  # invisible, direction
    "\ud800-\udfff"  # halves of characters, which no stream can encode
)
_COLOUR = "\x1b\\[[0-9;:]{0,40}m"
_ANY = re.compile(f"[\n\x1b{_UNSAFE}]")
_ANY_BUT_INDENTED_LINES = re.compile(f"\n(?!  )|[\x1b{_UNSAFE}]")
_ANY_BUT_COLOURS = re.compile(f"(?!{_COLOUR})[\n\x1b{_UNSAFE}]")
_COLOURS = re.compile(_COLOUR)


def printable(text: str) -> str:
    """Return a text as one line with newlines and control characters escaped."""
    return _ANY.sub(_escape, text)


def printable_message(text: str) -> str:
    """Return a message of several lines with control characters escaped.

    A newline stays only if the next line is indented, so that no part of the message can pass for
    another message.
    """
    return _ANY_BUT_INDENTED_LINES.sub(_escape, text)


def printable_coloured(text: str) -> str:
    """Return a text as one line with everything escaped but sequences that set a colour."""
    return _ANY_BUT_COLOURS.sub(_escape, text)


def without_colours(text: str) -> str:
    """Return a text without the sequences that set a terminal's colour."""
    return _COLOURS.sub("", text) if "\x1b" in text else text


def _escape(match: re.Match[str]) -> str:
    return match[0].encode("unicode_escape", "surrogatepass").decode("ascii")
