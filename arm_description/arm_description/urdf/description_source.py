"""Records a description's file in its text, for readers that get only the text.

A processing instruction at the start names the description's file and the user's package folders.
URDF readers ignore it; the simulation, the page and the check read it and search for meshes in the
same places.
"""

import os
import re
from collections.abc import Sequence
from pathlib import Path
from urllib.parse import unquote_to_bytes

from arm_node.frozen import frozen

TARGET = "description_source"
_INSTRUCTION = re.compile(rf"<\?{TARGET}\s([^?]*)\?>")
_DECLARATION = re.compile(r"\A\ufeff?\s*(<\?xml\s[^>]*\?>)?")
_MAX_OFFSET = 2000
"""Characters from the start within which the instruction must begin."""


@frozen
class DescriptionSource:
    """Where a description comes from.

    Attributes:
        file: absolute path, or None if unknown.
        package_path: folders that the user named for its packages.
    """

    file: Path | None = None
    package_path: tuple[Path, ...] = ()


def with_source(urdf: str, file: Path, package_path: Sequence[Path] = ()) -> str:
    """Return a description with the path of its file, unless it already has one.

    Line numbers stay the same.
    """
    if _instruction(urdf) is not None:
        return urdf
    uris = " ".join(path.absolute().as_uri() for path in (file, *package_path))
    # Before any comment, because some parsers accept instructions only there.
    start = _DECLARATION.match(urdf)
    end = start.end() if start else 0
    return f"{urdf[:end]}<?{TARGET} {uris}?>{urdf[end:]}"


def source_of(urdf: str) -> DescriptionSource:
    """Return the source that is recorded in a description."""
    found = _instruction(urdf)
    uris = found.group(1).split() if found else []
    names = [os.fsdecode(unquote_to_bytes(uri.removeprefix("file://"))) for uri in uris]
    paths = [Path(name) for name in names if "\0" not in name]
    return DescriptionSource(paths[0], tuple(paths[1:])) if paths else DescriptionSource()


def _instruction(urdf: str) -> re.Match[str] | None:
    found = _INSTRUCTION.search(urdf)
    return found if found and found.start() < _MAX_OFFSET else None
