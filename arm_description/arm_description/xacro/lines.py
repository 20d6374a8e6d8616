"""Finds the line of a xacro file where an expansion failed; xacro does not keep lines."""

import traceback
import xml.dom.minidom as minidom
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any, NamedTuple
from xml.dom import Node
from xml.dom.expatbuilder import ExpatBuilderNS
from xml.parsers.expat import ExpatError

KEY = "place"
NODE = "node"
"""The variable in xacro's functions that holds the expanded element."""


class Place(NamedTuple):
    """A line of a file; 0 if unknown."""

    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}, line {self.line}" if self.line else self.file


@contextmanager
def lines_kept() -> Iterator[None]:
    """Make xacro read its files so that elements, and their copies in macros, know their line."""
    import xacro

    original: Any = xacro.parse

    def parse(source: Any, filename: str | None = None) -> minidom.Document:
        if source is not None or filename is None:
            return original(source, filename)
        # The function that xacro would use, which applies this suite's limits.
        opened: Any = getattr(xacro, "open", open)
        try:
            file = opened(str(Path(xacro.root_dir or "") / filename))
        except OSError:
            return original(source, filename)
        with file:
            return _Builder(str(filename)).parseFile(file)

    xacro.parse = parse
    try:
        yield
    finally:
        xacro.parse = original


def place_of(error: Exception, files: list[str]) -> Place:
    """Return the place where an expansion failed.

    Args:
        error: xacro's exception.
        files: the files that xacro was reading, the outermost first.
    """
    file = files[-1] if files else ""
    if isinstance(error, ExpatError):
        return Place(file, int(error.lineno))
    frames: list[FrameType] = [frame for frame, _ in traceback.walk_tb(error.__traceback__)]
    for frame in reversed(frames):
        node: Any = frame.f_locals.get(NODE)
        while isinstance(node, Node):
            place = node.getUserData(KEY) if isinstance(node, minidom.Element) else None
            if isinstance(place, Place):
                return place
            node = node.parentNode  # pyright: ignore[reportAttributeAccessIssue]
    return Place(file, 0)


class _Builder(ExpatBuilderNS):
    """Builds a document whose elements know their place."""

    def __init__(self, filename: str) -> None:
        super().__init__()
        self._filename = filename

    def start_element_handler(self, name: str, attributes: list[str]) -> None:
        super().start_element_handler(name, attributes)
        line = self.getParser().CurrentLineNumber
        self.curNode.setUserData(KEY, Place(self._filename, line), _PASS_ON)


class _PassOn:
    """Passes an element's place to its copies; each use of a macro makes one."""

    def handle(self, operation: int, key: str, data: object, src: Any, dst: Any) -> None:
        """Give the copy `dst` the place of `src`; called by minidom."""
        if dst is not None:
            dst.setUserData(key, data, self)


_PASS_ON = _PassOn()
