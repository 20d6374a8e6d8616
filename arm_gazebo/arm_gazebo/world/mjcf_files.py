"""Files that an MJCF names: none that lies elsewhere than beside it or below."""

from pathlib import Path

from arm_description.xml_document import parse_xml
from arm_gazebo.world.refusal import Refusal, RefusedError

SIDES = ("right", "left", "up", "down", "front", "back")
"""Those of a cube that a texture has a file each for."""
NAMING = ("file", "meshdir", "texturedir", "assetdir", *(f"file{side}" for side in SIDES))
"""Attributes that name a file, or the folder of files."""
NESTING = ("include", "model")
"""Elements whose file is an MJCF, too, which may name further ones."""


def check_mjcf_files(text: str, path: Path | None = None) -> None:
    """Refuse an MJCF that comes from anywhere and would have other people's files read.

    Args:
        text: the MJCF.
        path: its file; None for a text of none, which cannot name any.

    Raises:
        RefusedError: it names a file that is not beside it or below; the message says which.
        XmlError: it, or an MJCF that it includes, is no XML.
    """
    _check(text, path, (), set())


def _check(text: str, path: Path | None, above: tuple[Path, ...], seen: set[Path]) -> None:
    """Check an MJCF and those in it; `above` are the folders of those that include it."""
    folders = above if path is None else (*above, path.parent)
    for element in parse_xml(text, "resource_string" if path is None else str(path)).iter("*"):
        for name in NAMING:
            value = element.get(name)
            if value is not None:
                _check_name(name, value, path)
        if element.tag not in NESTING:
            continue
        # One that is not there is MuJoCo's to name.
        for nested in (folder / element.get("file", "") for folder in folders):
            if nested.is_file() and nested not in seen:
                seen.add(nested)
                _check(nested.read_text(encoding="utf-8"), nested, folders, seen)


def _check_name(name: str, value: str, path: Path | None) -> None:
    if path is None:
        problem = "a text has no folder; give a uri instead"
    elif Path(value).is_absolute() or ".." in Path(value).parts:
        problem = "it is neither beside the MJCF file nor below it"
    else:
        return
    raise RefusedError(Refusal.MISSING_ASSETS, f"{name}='{value}' is not read: {problem}")
