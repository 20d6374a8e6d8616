"""Files that a user drops on the page, as they arrive in parts from a browser."""

from collections.abc import Callable
from dataclasses import dataclass, field

from arm_viewer.channel import Browser, Channel, Message
from arm_viewer.errors import BrowserMessageError, DroppedFileError
from arm_viewer.world.dropped_file import DroppedFile, check_size

PART, TAKEN = "file_part", "file_taken"
"""Kinds of messages: a part of a file from a browser, and how much of it the page has."""


@dataclass(slots=True)
class _Arriving:
    name: str
    size: int
    data: bytearray = field(default_factory=bytearray)


class FileDrop:
    """Puts parts together, one file at a time of each browser; use it in viser's event loop."""

    def __init__(self, channel: Channel, take: Callable[[DroppedFile], None]) -> None:
        """Serve the browsers' messages; each complete file goes to `take`."""
        self._take = take
        self._arriving: dict[Browser, _Arriving] = {}
        channel.on(PART, self._take_part)

    def forget_the_gone(self) -> None:
        """Drop what browsers had begun to send that have left."""
        self._arriving = {b: file for b, file in self._arriving.items() if b.is_connected}

    def _take_part(self, message: Message, browser: Browser) -> None:
        offset = message.number("offset")
        if not offset:
            self._arriving[browser] = _begun(message)
        file = self._arriving.pop(browser, None)
        part = message.data("data")
        if file is None or offset != len(file.data) or len(file.data) + len(part) > file.size:
            raise BrowserMessageError("a part of the file is missing: drop it again")
        file.data += part
        if len(file.data) < file.size:
            self._arriving[browser] = file
        else:
            self._take(DroppedFile(file.name, bytes(file.data)))
        browser.send(TAKEN, {"name": file.name, "bytes": len(file.data), "of": file.size})


def _begun(message: Message) -> _Arriving:
    name, size = message.text("name"), message.number("size")
    try:
        check_size(name, int(size))
    except DroppedFileError as error:
        raise BrowserMessageError(str(error)) from error
    return _Arriving(name, int(size))
