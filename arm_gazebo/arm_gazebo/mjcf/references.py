"""The files that an MJCF refers to, and whether MuJoCo can read them.

MuJoCo opens them by itself: a FIFO blocks it for ever.
"""

import os
from collections.abc import Iterator, Mapping
from pathlib import Path

from arm_description.urdf.xml_document import parse_xml
from arm_gazebo.errors import ModelError
from arm_node.frozen import frozen
from arm_node.user_file import UnusableFileError, check_file, read_text

SIDES = ("right", "left", "up", "down", "front", "back")
"""Sides of a cube texture, each of which may have its own file."""
FILES = ("file", *(f"file{side}" for side in SIDES))
"""Attributes that name a file."""
FOLDERS = ("meshdir", "texturedir", "assetdir")
"""Attributes of <compiler> that name a folder."""
INCLUDE_ELEMENTS = ("include", "model")
"""Elements whose file is another MJCF, which may name further files."""


@frozen
class MjcfReference:
    """A file or folder that an MJCF names.

    Attributes:
        attribute: one of FILES or FOLDERS.
        value: the file or folder as written.
        line: line of the element.
        source: the MJCF, None for a text.
        folders: the folders of the MJCF and of its includers, the outermost first.
    """

    attribute: str
    value: str
    line: int
    source: Path | None
    folders: tuple[Path, ...]


def references(text: str, path: Path | None) -> Iterator[MjcfReference]:
    """Yield what an MJCF and those that it includes name.

    Raises:
        XmlError: the MJCF, or one that it includes, is not XML.
        OSError: an included file cannot be read.
    """
    yield from _references(text, path, (), set())


def check_readable(text: str, path: Path) -> None:
    """Refuse an MJCF that refers to something that is not a regular file.

    MuJoCo itself reports a missing file.

    Raises:
        ModelError: it does; the message names the file.
        XmlError, OSError: see `references`.
    """
    found = list(references(text, path))
    # The last <compiler> counts.
    folders = {each.attribute: each.value for each in found if each.attribute in FOLDERS}
    for reference in found:
        if reference.attribute in FILES:
            _check(reference, folders)


def _references(
    text: str, path: Path | None, above: tuple[Path, ...], seen: set[Path]
) -> Iterator[MjcfReference]:
    folders = above if path is None else (*above, path.parent)
    for element in parse_xml(text, "resource_string" if path is None else str(path)).iter("*"):
        for attribute in (*FILES, *FOLDERS):
            value = element.get(attribute)
            if value is not None:
                yield MjcfReference(attribute, value, int(element.sourceline or 0), path, folders)
        if element.tag not in INCLUDE_ELEMENTS:
            continue
        for nested in (folder / element.get("file", "") for folder in folders):
            if os.path.isfile(nested) and nested not in seen:
                seen.add(nested)
                yield from _references(read_text(nested), nested, folders, seen)


def _check(reference: MjcfReference, given: Mapping[str, str]) -> None:
    """Look for a file where MuJoCo may: beside the MJCF and in its folders of assets."""
    file = Path(reference.value)
    for folder in reference.folders:
        for inside in ("", *given.values()):
            # With <compiler strippath="true"> only the file's name counts.
            for place in dict.fromkeys((folder / inside / file, folder / inside / file.name)):
                try:
                    if not os.path.isdir(place):
                        check_file(place)
                except UnusableFileError as error:
                    raise ModelError(
                        f"line {reference.line}: cannot read {place}: {error}"
                    ) from error
                except (OSError, ValueError):
                    continue
