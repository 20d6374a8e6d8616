"""Makes text from outside safe to show on a terminal and to log.

Names and strings come from other processes and from files. They may contain sequences that clear
the screen, rename the window or hide text, newlines that forge log lines, and characters that
reverse the reading direction. These become visible Python escapes.

`launch_py.printable` does the same for the output of processes; launch_py does not import this
package.
"""

import re

_UNSAFE = (
    "\x00-\x08\x0b-\x1f\x7f-\x9f"  # control characters except tab and newline
    "\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"  # invisible, direction
    "\ud800-\udfff"  # surrogates, which no stream can encode
)
# `re` compiles each when it is first used, because many programs show no text from outside.
_ANY = f"[\n{_UNSAFE}]"
_ANY_BUT_INDENTED_LINES = f"\n(?!  )|[{_UNSAFE}]"
_POSITION = r",? at /\S+\.cp?p?:\d+$"
_ANY_BUT_LINES = f"[{_UNSAFE}]"


def first_line(error: BaseException) -> str:
    """Return the first line of an error's message, without the C source position of rcl."""
    text = str(error).strip()
    return re.sub(_POSITION, "", text.splitlines()[0]) if text else type(error).__name__


def printable(text: str) -> str:
    """Return a text as one safe line: newlines and control characters are escaped."""
    return re.sub(_ANY, _escape, text)


def printable_message(text: str) -> str:
    """Return a message of several lines, safe to show.

    A newline is kept only if the next line is indented, so that no part looks like a separate
    message.
    """
    return re.sub(_ANY_BUT_INDENTED_LINES, _escape, text)


def printable_document(text: str) -> str:
    """Return a text that is shown separately, such as a file; its newlines are kept."""
    return re.sub(_ANY_BUT_LINES, _escape, text)


def _escape(match: re.Match[str]) -> str:
    return match[0].encode("unicode_escape", "surrogatepass").decode("ascii")
